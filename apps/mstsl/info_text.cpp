#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "info.hpp"

namespace mstsl::app {
namespace {

constexpr std::array<std::string_view, 8> kUnits{"m", "m2", "s", "uT", "uT2", "Hz", "rad", "percent"};

struct Label {
  std::string words;
  std::string unit;
};

/// "free_area_m2" is "free area" in m2.
Label label_of(const std::string& key) {
  const std::size_t last = key.rfind('_');
  Label label{key, ""};
  if (last != std::string::npos) {
    const std::string_view end = std::string_view(key).substr(last + 1);
    if (std::ranges::find(kUnits, end) != kUnits.end()) label = {key.substr(0, last), std::string(end)};
  }
  std::ranges::replace(label.words, '_', ' ');
  return label;
}

std::string scalar(const Description& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (value.is_null()) return "none";
  return value.is_boolean() ? (value.get<bool>() ? "yes" : "no") : value.dump();
}

std::string with_unit(const Description& value, const std::string& unit) {
  return unit.empty() || value.is_null() ? scalar(value)
                                         : scalar(value) + " " + (unit == "percent" ? "%" : unit);
}

/// "x 1.5 m, y 2 m".
std::string inline_object(const Description& object) {
  std::string text;
  for (const auto& [key, value] : object.items()) {
    const Label label = label_of(key);
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", label.words, with_unit(value, label.unit));
  }
  return text.empty() ? "none" : text;
}

/// Rows of objects that share their keys, in columns.
std::string table(const Description& rows) {
  std::vector<std::vector<std::string>> cells(rows.size() + 1);
  for (const auto& [key, value] : rows.front().items()) {
    const Label label = label_of(key);
    cells[0].push_back(label.unit.empty() ? label.words : label.words + " (" + label.unit + ")");
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const auto& value : rows[i]) cells[i + 1].push_back(scalar(value));
  std::vector<std::size_t> widths(cells[0].size());
  for (const auto& row : cells)
    for (std::size_t k = 0; k < widths.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  std::string text;
  for (const auto& row : cells) {
    std::string line = "   ";
    for (std::size_t k = 0; k < row.size(); ++k) line += fmt::format(" {:<{}} ", row[k], widths[k]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string lines_for(const std::string& key, const Description& value, std::size_t width) {
  const Label label = label_of(key);
  if (value.is_array() && value.empty()) return "";
  if (value.is_array() && value.front().is_object())
    return fmt::format("  {}:\n{}", label.words, table(value));
  if (value.is_array()) {
    std::string text = fmt::format("  {}:\n", label.words);
    for (const auto& item : value) text += fmt::format("    {}\n", scalar(item));
    return text;
  }
  const std::string shown = value.is_object() ? inline_object(value) : with_unit(value, label.unit);
  return fmt::format("  {:<{}} {}\n", label.words + ":", width + 1, shown);
}

}  // namespace

std::string to_text(const Description& description) {
  std::string text = fmt::format("{}: {}\n", description.value("file", ""), description.value("kind", ""));
  std::size_t width = 0;
  for (const auto& [key, value] : description.items())
    if (!value.is_array()) width = std::max(width, label_of(key).words.size());
  for (const auto& [key, value] : description.items())
    if (key != "file" && key != "kind") text += lines_for(key, value, width);
  return text;
}

}  // namespace mstsl::app
