#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"
#include "mstsl/io/estimates.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "file_problem.hpp"
#include "text_numbers.hpp"

namespace mstsl::io {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxBytes = std::size_t{1} << 32;

const json& member(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) throw FileProblem("has no '{}'", key);
  return *found;
}

double number(const json& value, const char* key) {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw FileProblem("has a '{}' that is no finite number", key);
  return value.get<double>();
}

double number_in(const json& object, const char* key) { return number(member(object, key), key); }

double probability_in(const json& object, const char* key) {
  constexpr double kRounding = 1e-9;  // weights that were normalised may miss 0 or 1 by their last digits
  const double value = number_in(object, key);
  if (value < -kRounding || value > 1.0 + kRounding)
    throw FileProblem("has a '{}' of {}, not between 0 and 1", key, value);
  return value;
}

std::vector<double> numbers_in(const json& object, const char* key, std::size_t count) {
  const json& list = member(object, key);
  if (!list.is_array() || list.size() != count)
    throw FileProblem("has a '{}' that is no list of {} numbers", key, count);
  std::vector<double> values;
  for (const json& item : list) values.push_back(number(item, key));
  return values;
}

Pose2 pose_in(const json& object, const char* key) {
  if (!object.is_object()) throw FileProblem("has a '{}' that is no object with x, y, yaw", key);
  const double x = number_in(object, "x");
  const double y = number_in(object, "y");
  return Pose2::from({x, y}, number_in(object, "yaw"));
}

LocalizationStatus status_in(const json& object) {
  const json& name = member(object, "status");
  for (const auto status :
       {LocalizationStatus::kSearching, LocalizationStatus::kLocalized, LocalizationStatus::kLost})
    if (name == to_string(status)) return status;
  throw FileProblem("has a 'status' that is not searching, localized or lost");
}

Stamp stamp_in(const json& object) {
  const double t_s = number_in(object, "t");
  if (std::abs(t_s) > 9e9) throw FileProblem("has a 't' of {} s, which is no time", t_s);
  return Stamp::from_seconds(t_s);
}

Estimate estimate_from(const json& object) {
  Estimate e;
  e.stamp = stamp_in(object);
  e.travelled_m = number_in(object, "travelled_m");
  e.status = status_in(object);
  if (const json& pose = member(object, "pose"); !pose.is_null()) e.map_T_base = pose_in(pose, "pose");
  e.covariance = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      numbers_in(object, "covariance", 9).data());
  e.probability = probability_in(object, "probability");
  const json& hypotheses = member(object, "hypotheses");
  if (!hypotheses.is_array()) throw FileProblem("has 'hypotheses' that are no list");
  for (const json& h : hypotheses)
    e.hypotheses.push_back({pose_in(h, "hypotheses"), probability_in(h, "weight")});
  if (!member(object, "bias_uT").is_null())
    e.bias_uT = Eigen::Map<const Eigen::Vector3d>(numbers_in(object, "bias_uT", 3).data());
  return e;
}

SummaryValue summary_value(const json& value) {
  if (value.is_null()) return nullptr;
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number_float()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  return value.dump();
}

Summary summary_from(const json& object) {
  if (!object.is_object()) throw FileProblem("has a 'summary' that is no object");
  Summary summary;
  for (const auto& [name, value] : object.items()) summary.emplace(name, summary_value(value));
  return summary;
}

void read_line(std::string_view line, EstimatesFile& file) {
  const json object = json::parse(line, nullptr, false);
  if (!object.is_object()) throw FileProblem("is no JSON object");
  if (file.summary) throw FileProblem("comes after the summary, which must be the last line");
  if (const auto summary = object.find("summary"); summary != object.end())
    file.summary = summary_from(*summary);
  else
    file.estimates.push_back(estimate_from(object));
}

EstimatesFile parse(std::string_view text) {
  EstimatesFile file;
  const std::vector<std::string_view> lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool cut_off = i + 1 == lines.size() && !text.ends_with('\n');
    if (lines[i].empty() || (cut_off && !json::accept(lines[i]))) continue;
    try {
      read_line(lines[i], file);
    } catch (const FileProblem& problem) {
      throw FileProblem("line {} {}", i + 1, problem.what());
    }
  }
  return file;
}

}  // namespace

Result<EstimatesFile> read_estimates(const std::filesystem::path& file) {
  const Result<std::string> text = read_file(file, kMaxBytes);
  std::error_code ignored;
  if (!text && std::filesystem::exists(part_name(file), ignored))
    return Error(fmt::format("{}; an interrupted run left {}, which can be read in its place",
                             text.error().message(), part_name(file).string()));
  if (!text) return text.error();
  return guarded(file, [&] { return parse(*text); });
}

}  // namespace mstsl::io
