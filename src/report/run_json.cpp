#include "run_json.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace mstsl::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostSteps =
    1500;  // of a method, of the truth: more than there are pixels to scrub over
constexpr std::size_t kMostHypotheses = 10;

/// What is read by people needs no more digits than this.
double digits(double value, int count) {
  const double scale = std::pow(10.0, count);
  return std::round(value * scale) / scale;
}
Json pose_json(const Pose2& pose) { return {digits(pose.x, 3), digits(pose.y, 3), digits(pose.yaw, 4)}; }

/// Every n-th, so that no more than kMostSteps are left.
std::size_t stride(std::size_t count) { return (count + kMostSteps - 1) / kMostSteps; }

Stamp begin_of(const RunTrace& run) {
  std::optional<Stamp> first;
  const auto take = [&](Stamp stamp) { first = first ? std::min(*first, stamp) : stamp; };
  if (!run.truth.empty()) take(run.truth.front().stamp);
  if (!run.scans.empty()) take(run.scans.front().stamp);
  for (const TracedMethod& method : run.methods)
    if (!method.estimates.empty()) take(method.estimates.front().stamp);
  return first.value_or(Stamp{});
}

Json truth_json(const Trajectory& truth, Stamp begin) {
  Json json{{"t", Json::array()}, {"x", Json::array()}, {"y", Json::array()}, {"yaw", Json::array()}};
  for (std::size_t i = 0; i < truth.size(); i += std::max<std::size_t>(1, stride(truth.size()))) {
    json["t"].push_back(digits(truth[i].stamp - begin, 3));
    json["x"].push_back(digits(truth[i].pose.x, 3));
    json["y"].push_back(digits(truth[i].pose.y, 3));
    json["yaw"].push_back(digits(truth[i].pose.yaw, 4));
  }
  return json;
}

Json scans_json(const std::vector<TracedScan>& scans, Stamp begin) {
  Json list = Json::array();
  for (const TracedScan& scan : scans) {
    Json points = Json::array();
    for (const Eigen::Vector2d& p : scan.points_base_m) {
      points.push_back(static_cast<int>(std::lround(100.0 * p.x())));
      points.push_back(static_cast<int>(std::lround(100.0 * p.y())));
    }
    list.push_back({{"t", digits(scan.stamp - begin, 3)}, {"points", std::move(points)}});
  }
  return list;
}

Json method_json(const TracedMethod& method, Stamp begin) {
  Json json{{"name", method.name},        {"t", Json::array()}, {"d", Json::array()},
            {"status", Json::array()},    {"p", Json::array()}, {"pose", Json::array()},
            {"hypotheses", Json::array()}};
  for (std::size_t i = 0; i < method.estimates.size();
       i += std::max<std::size_t>(1, stride(method.estimates.size()))) {
    const Estimate& e = method.estimates[i];
    json["t"].push_back(digits(e.stamp - begin, 3));
    json["d"].push_back(digits(e.travelled_m, 3));
    json["status"].push_back(static_cast<int>(e.status));
    json["p"].push_back(digits(e.probability, 6));
    json["pose"].push_back(e.map_T_base ? pose_json(*e.map_T_base) : Json());
    Json hypotheses = Json::array();
    for (std::size_t k = 0; k < std::min(kMostHypotheses, e.hypotheses.size()); ++k) {
      hypotheses.push_back(pose_json(e.hypotheses[k].map_T_base));
      hypotheses.back().push_back(digits(e.hypotheses[k].weight, 4));
    }
    json["hypotheses"].push_back(std::move(hypotheses));
  }
  return json;
}

}  // namespace

std::string run_json(const RunTrace& run, std::size_t place) {
  const Stamp begin = begin_of(run);
  Json methods = Json::array();
  for (const TracedMethod& method : run.methods) methods.push_back(method_json(method, begin));
  return Json{{"name", run.name},
              {"place", place},
              {"truth", truth_json(run.truth, begin)},
              {"scans", scans_json(run.scans, begin)},
              {"methods", std::move(methods)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mstsl::report
