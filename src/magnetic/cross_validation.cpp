#include "mstsl/magnetic/cross_validation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mstsl/magnetic/lanes.hpp"

#include "point_bins.hpp"

namespace mstsl {
namespace {

using Eigen::Array3d;
using Eigen::Vector2d;

/// Grows a range of the drive in both directions by a way in m, within its session.
Lane widened(std::span<const Fingerprint> fingerprints, Lane lane, double way_m) {
  const auto step = [&](std::size_t a, std::size_t b) {
    return (fingerprints[a].position_m - fingerprints[b].position_m).norm();
  };
  const int session = fingerprints[lane.first].session;
  for (double way = 0.0; lane.first > 0 && fingerprints[lane.first - 1].session == session; --lane.first)
    if ((way += step(lane.first, lane.first - 1)) > way_m) break;
  for (double way = 0.0; lane.last < fingerprints.size() && fingerprints[lane.last].session == session;
       ++lane.last)
    if ((way += step(lane.last - 1, lane.last)) > way_m) break;
  return lane;
}

/// The middle of a lane, at most `length_m` of it.
Lane middle_of(std::span<const Fingerprint> fingerprints, const Lane& lane, double length_m) {
  const std::size_t center = lane.first + lane.size() / 2;
  const Lane stretch = widened(fingerprints, {center, center + 1}, 0.5 * length_m);
  return {std::max(stretch.first, lane.first), std::min(stretch.last, lane.last)};
}

std::vector<std::size_t> spread_evenly(const Lane& lane, std::size_t count) {
  count = std::min(count, lane.size());
  std::vector<std::size_t> indices(count);
  for (std::size_t k = 0; k < count; ++k) indices[k] = lane.first + (2 * k + 1) * lane.size() / (2 * count);
  return indices;
}

/// The nearest fingerprints to a stretch that are neither on its own part of the drive nor within the radius
/// of it.
std::vector<std::size_t> training_for(std::span<const Vector2d> points, const PointBins& bins,
                                      const Lane& own, const Lane& stretch, const HoldOutOptions& options) {
  const Vector2d center = points[stretch.first + stretch.size() / 2];
  const auto near_stretch = [&](std::size_t i) {
    for (std::size_t k = stretch.first; k < stretch.last; ++k)
      if ((points[i] - points[k]).norm() < options.radius_m) return true;
    return false;
  };
  std::vector<std::pair<double, std::size_t>> by_distance;
  // Farther than this a fingerprint says nothing: lengths are chosen from the field's length scale.
  const double reach_m = 5.0 * options.length_m + options.radius_m;
  for (const std::size_t i : bins.in_box(center.array() - reach_m, center.array() + reach_m))
    if ((i < own.first || i >= own.last) && !(options.radius_m > 0.0 && near_stretch(i)))
      by_distance.emplace_back((points[i] - center).squaredNorm(), i);
  std::sort(by_distance.begin(), by_distance.end());
  by_distance.resize(std::min(by_distance.size(), options.training));
  std::vector<std::size_t> training;
  for (const auto& [distance, i] : by_distance) training.push_back(i);
  return training;
}

}  // namespace

std::vector<HeldOutStretch> hold_out_lanes(std::span<const Fingerprint> fingerprints,
                                           const HoldOutOptions& options) {
  std::vector<Vector2d> points;
  for (const Fingerprint& f : fingerprints) points.push_back(f.position_m);
  const PointBins bins(points, std::max(0.1, options.length_m));
  const std::vector<Lane> lanes = split_lanes(fingerprints);
  const std::size_t count = std::min(options.stretches, lanes.size());
  std::vector<HeldOutStretch> stretches;
  for (std::size_t k = 0; k < count; ++k) {
    const Lane& lane = lanes[k * lanes.size() / count];
    const Lane stretch = middle_of(fingerprints, lane, options.length_m);
    const Lane own = widened(fingerprints, lane, options.length_m);
    HeldOutStretch held_out{spread_evenly(stretch, options.tested),
                            training_for(points, bins, own, stretch, options)};
    if (!held_out.training.empty()) stretches.push_back(std::move(held_out));
  }
  return stretches;
}

std::vector<HeldOutError> held_out_errors(std::span<const Fingerprint> fingerprints,
                                          const std::vector<HeldOutStretch>& stretches,
                                          const Predictor& predict, Threads threads) {
  std::vector<std::vector<HeldOutError>> parts(stretches.size());
  parallel_for(stretches.size(), threads, [&](std::size_t s) {
    std::vector<Fingerprint> training;
    std::vector<Vector2d> points;
    for (const std::size_t i : stretches[s].training) training.push_back(fingerprints[i]);
    for (const std::size_t i : stretches[s].tested) points.push_back(fingerprints[i].position_m);
    const auto predictions = predict(training, points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (!predictions[k]) continue;
      const Eigen::Vector3d& seen = fingerprints[stretches[s].tested[k]].field_uT;
      parts[s].push_back({(seen - predictions[k]->mean_uT).array(), predictions[k]->variance_uT2.array(), 1.0,
                          s, stretches[s].tested[k]});
    }
  });
  std::vector<HeldOutError> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace mstsl
