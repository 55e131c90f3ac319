#include "text_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>

#include <fmt/format.h>

namespace mstsl::io {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// A fraction's digits as nanoseconds: "5" is half a second.
std::int64_t nanoseconds_of(std::string_view digits) {
  std::int64_t ns = 0;
  for (std::size_t i = 0; i < 9; ++i) ns = ns * 10 + (i < digits.size() ? digits[i] - '0' : 0);
  return ns;
}

}  // namespace

std::string to_text(double value) { return fmt::format("{}", value + 0.0); }

std::string to_text(Stamp stamp) {
  const auto magnitude =
      stamp.ns < 0 ? 0 - static_cast<std::uint64_t>(stamp.ns) : static_cast<std::uint64_t>(stamp.ns);
  std::string text =
      fmt::format("{}{}.{:09}", stamp.ns < 0 ? "-" : "", magnitude / kNanoseconds, magnitude % kNanoseconds);
  const std::size_t last = text.find_last_not_of('0');
  text.resize(std::max(last, text.find('.') + 1) + 1);
  return text;
}

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<Stamp> parse_stamp(std::string_view text) {
  constexpr double kMost_s = 9e9;
  const std::optional<double> number = parse_number(text);
  if (!number || std::abs(*number) > kMost_s) return std::nullopt;
  const bool negative = text.starts_with('-');
  std::string_view digits = text.substr(negative || text.starts_with('+') ? 1 : 0);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::string_view whole = digits.substr(0, point);
  const std::string_view fraction = digits.substr(std::min(point + 1, digits.size()));
  if (!all_digits(whole) || !all_digits(fraction)) return Stamp::from_seconds(*number);  // 1.7e9
  std::int64_t seconds = 0;
  std::from_chars(whole.data(), whole.data() + whole.size(), seconds);
  const std::int64_t ns = seconds * kNanoseconds + nanoseconds_of(fraction);
  return Stamp{negative ? -ns : ns};
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> pieces;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(separator, at), line.size());
    if (separator != ' ' || end > at) pieces.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  return pieces;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    at = end + 1;
  }
  return lines;
}

}  // namespace mstsl::io
