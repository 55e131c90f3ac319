#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mstsl/core/stamp.hpp"

namespace mstsl::io {

/// The shortest decimal text that reads back as the same double; never "-0".
std::string to_text(double value);

/// Seconds with all nine decimals that are not trailing zeros ("12.5", "12.0"): no digit is lost, as a double
/// would.
std::string to_text(Stamp stamp);

/// The finite number that the whole text is; nothing else.
std::optional<double> parse_number(std::string_view text);

/// Seconds as decimal text to the nanosecond (digits beyond are dropped), within +- 9e9 s.
std::optional<Stamp> parse_stamp(std::string_view text);

/// The pieces of a line between separators; runs of spaces count as one where the separator is a space.
std::vector<std::string_view> split(std::string_view line, char separator);

/// The lines of a text, without their line ends (LF or CRLF).
std::vector<std::string_view> lines_of(std::string_view text);

}  // namespace mstsl::io
