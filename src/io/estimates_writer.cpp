#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "mstsl/io/estimates.hpp"

#include "text_numbers.hpp"

namespace mstsl::io {
namespace {

constexpr std::size_t kMaxHypotheses = 20;  // of a line, by the file's definition

bool all_finite(const Estimate& e) {
  const bool hypotheses = std::all_of(e.hypotheses.begin(), e.hypotheses.end(), [](const Hypothesis& h) {
    return h.map_T_base.is_finite() && std::isfinite(h.weight);
  });
  return hypotheses && std::isfinite(e.travelled_m) && std::isfinite(e.probability) &&
         e.covariance.allFinite() && (!e.map_T_base || e.map_T_base->is_finite()) &&
         (!e.bias_uT || e.bias_uT->allFinite());
}

template <typename Range>
std::string list(const Range& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + to_text(number);
  return "[" + text + "]";
}

std::string fields(const Pose2& pose) {
  return fmt::format(R"("x": {}, "y": {}, "yaw": {})", to_text(pose.x), to_text(pose.y), to_text(pose.yaw));
}

std::string hypotheses(const std::vector<Hypothesis>& all) {
  std::string text;
  for (std::size_t i = 0; i < std::min(all.size(), kMaxHypotheses); ++i)
    text += fmt::format(R"({}{{{}, "weight": {}}})", i == 0 ? "" : ", ", fields(all[i].map_T_base),
                        to_text(all[i].weight));
  return "[" + text + "]";
}

std::array<double, 9> row_major(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

std::string line_of(const Estimate& e) {
  const std::string pose = e.map_T_base ? "{" + fields(*e.map_T_base) + "}" : "null";
  const std::string bias =
      e.bias_uT ? list(std::array{e.bias_uT->x(), e.bias_uT->y(), e.bias_uT->z()}) : "null";
  return fmt::format(
      R"({{"t": {}, "travelled_m": {}, "status": "{}", "pose": {}, "covariance": {}, "probability": {}, "hypotheses": {}, "bias_uT": {}}})",
      to_text(e.stamp), to_text(e.travelled_m), to_string(e.status), pose, list(row_major(e.covariance)),
      to_text(e.probability), hypotheses(e.hypotheses), bias);
}

/// The summary's last line; a number that is not finite becomes null, as a figure that does not exist.
std::string line_of(const Summary& summary) {
  nlohmann::json object = nlohmann::json::object();
  for (const auto& [name, value] : summary)
    std::visit([&, &key = name](const auto& v) { object[key] = v; }, value);
  return nlohmann::json{{"summary", object}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

Result<std::string> to_json_line(const Estimate& estimate) {
  if (!all_finite(estimate))
    return Error(fmt::format(
        "the estimate at {} s holds a number that is not finite (this is a bug, please report it)",
        estimate.stamp.seconds()));
  return line_of(estimate);
}

Result<EstimatesWriter> EstimatesWriter::open(const std::filesystem::path& file) {
  Result<AtomicFile> opened = AtomicFile::open(file, IfDropped::kKeepPart);
  if (!opened) return opened.error();
  return EstimatesWriter(*std::move(opened));
}

Result<void> EstimatesWriter::write(const Estimate& estimate) {
  const Result<std::string> line = to_json_line(estimate);
  if (!line) return line.error().within(file_.target().string());
  const Result<void> written = file_.write(*line + "\n");
  return written ? file_.flush() : written;
}

Result<void> EstimatesWriter::close(const Summary& summary) {
  const Result<void> written = file_.write(line_of(summary) + "\n");
  return written ? file_.close() : written;
}

Result<void> EstimatesWriter::close() { return file_.close(); }

}  // namespace mstsl::io
