#include "mstsl/datasets/number_columns.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "mstsl/io/file_bytes.hpp"

namespace mstsl::datasets {
namespace {

constexpr std::size_t kLimitBytes = std::size_t{1} << 30;
constexpr std::string_view kBlank = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, comma - begin)));
    begin = comma + 1;
  }
}

std::optional<double> finite_number(std::string_view text) {
  double number = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
    return std::nullopt;
  return number;
}

/// Lines that hold something, with their numbers from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  std::optional<std::string_view> next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      const std::string_view line = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (!line.empty()) return line;
    }
    return std::nullopt;
  }
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

Result<std::vector<std::size_t>> places_of(std::span<const std::string_view> names,
                                           const std::vector<std::string_view>& header) {
  std::vector<std::size_t> places;
  for (const std::string_view name : names) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end())
      return Error(
          fmt::format("no column '{}'; those in its first line are: {}", name, fmt::join(header, ", ")));
    places.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return places;
}

using Columns = std::vector<std::vector<double>>;

/// Which fields of a line are asked for, what they are called, and how many fields there must be.
struct Layout {
  std::vector<std::size_t> places;
  std::vector<std::string> names;
  std::size_t width = 0;
  std::string_view width_from;
};

Result<Columns> parse_rows(Lines& lines, const Layout& layout) {
  Columns columns(layout.places.size());
  std::vector<std::string_view> fields;
  while (const auto line = lines.next()) {
    split(*line, fields);
    if (fields.size() != layout.width)
      return Error(fmt::format("line {} has {} fields where {} {}; is the file cut off?", lines.number(),
                               fields.size(), layout.width_from, layout.width));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string_view field = fields[layout.places[i]];
      const auto number = finite_number(field);
      if (!number)
        return Error(fmt::format("line {}: '{}' in column '{}' is no finite number", lines.number(), field,
                                 layout.names[i]));
      columns[i].push_back(*number);
    }
  }
  return columns;
}

Result<Columns> parse(std::string_view text, std::span<const std::string_view> names) {
  Lines lines(text);
  std::vector<std::string_view> fields;
  std::string_view header = lines.next().value_or("");
  if (header.starts_with('#')) header.remove_prefix(1);
  split(header, fields);
  const Result<std::vector<std::size_t>> places = places_of(names, fields);
  if (!places) return places.error();
  Result<Columns> columns =
      parse_rows(lines, {*places, {names.begin(), names.end()}, fields.size(), "the first line names"});
  if (columns && (columns->empty() || columns->front().empty()))
    return Error("there is no row under its first line");
  return columns;
}

Layout numbered(std::size_t width) {
  Layout layout{{}, {}, width, "there should be"};
  for (std::size_t i = 0; i < width; ++i) {
    layout.places.push_back(i);
    layout.names.push_back(std::to_string(i + 1));
  }
  return layout;
}

}  // namespace

Result<Columns> read_number_columns(const std::filesystem::path& file,
                                    std::span<const std::string_view> names) {
  const Result<std::string> text = io::read_file(file, kLimitBytes);
  if (!text) return text.error();
  Result<Columns> columns = parse(*text, names);
  if (!columns) return columns.error().within(file.string());
  return columns;
}

Result<Columns> read_number_rows(const std::filesystem::path& file, std::size_t width) {
  const Result<std::string> text = io::read_file(file, kLimitBytes);
  if (!text) return text.error();
  Lines lines(*text);
  Result<Columns> columns = parse_rows(lines, numbered(width));
  if (!columns) return columns.error().within(file.string());
  if (columns->front().empty()) return Error(file.string() + ": there is no row in it");
  return columns;
}

}  // namespace mstsl::datasets
