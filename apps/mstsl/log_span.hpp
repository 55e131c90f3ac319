#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "mstsl/core/stamp.hpp"

namespace mstsl::app {

/// When logs begin and how long they last, for a progress bar.
struct LogSpan {
  Stamp begin;
  double seconds;

  /// How much of them lies before a time, 0 .. 1.
  double share(Stamp now) const;
  Stamp end() const { return begin + seconds; }
};

/// Of logs played one after the other; nothing where they do not say.
std::optional<LogSpan> span_of(const std::vector<std::filesystem::path>& logs);

}  // namespace mstsl::app
