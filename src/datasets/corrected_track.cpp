#include "mstsl/datasets/corrected_track.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace mstsl::datasets {

std::optional<Pose2> odometry_at(std::span<const OdometryReading> odometry, Stamp stamp) {
  const auto after =
      std::lower_bound(odometry.begin(), odometry.end(), stamp,
                       [](const OdometryReading& reading, Stamp s) { return reading.stamp < s; });
  if (after == odometry.end()) return std::nullopt;
  if (after->stamp == stamp) return after->odom_T_base;
  if (after == odometry.begin()) return std::nullopt;
  const auto before = after - 1;
  return interpolate(before->odom_T_base, after->odom_T_base,
                     (stamp - before->stamp) / (after->stamp - before->stamp));
}

CorrectedTrack::CorrectedTrack(std::span<const PoseReading> corrected,
                               std::span<const OdometryReading> odometry) {
  assert(!corrected.empty());
  auto reading = odometry.begin();
  for (std::size_t k = 0; k + 1 < corrected.size(); ++k) {
    const PoseReading& from = corrected[k];
    const PoseReading& to = corrected[k + 1];
    knots_.push_back(from);
    const auto odom_T_from = odometry_at(odometry, from.stamp);
    const auto odom_T_to = odometry_at(odometry, to.stamp);
    if (!odom_T_from || !odom_T_to) continue;
    const Pose2 drift = between(between(*odom_T_from, *odom_T_to), between(from.map_T_base, to.map_T_base));
    while (reading != odometry.end() && reading->stamp <= from.stamp) ++reading;
    for (; reading != odometry.end() && reading->stamp < to.stamp; ++reading) {
      const double share = (reading->stamp - from.stamp) / (to.stamp - from.stamp);
      const Pose2 from_T_base = between(*odom_T_from, reading->odom_T_base);
      knots_.push_back({reading->stamp, from.map_T_base * from_T_base * interpolate(Pose2{}, drift, share)});
    }
  }
  knots_.push_back(corrected.back());
}

Pose2 CorrectedTrack::at(Stamp stamp) const {
  const auto after = std::lower_bound(knots_.begin(), knots_.end(), stamp,
                                      [](const PoseReading& knot, Stamp s) { return knot.stamp < s; });
  if (after == knots_.begin()) return knots_.front().map_T_base;
  if (after == knots_.end()) return knots_.back().map_T_base;
  const auto before = after - 1;
  return interpolate(before->map_T_base, after->map_T_base,
                     (stamp - before->stamp) / (after->stamp - before->stamp));
}

}  // namespace mstsl::datasets
