#include "mstsl/mapping/bent_track.hpp"

#include "mstsl/core/angles.hpp"

namespace mstsl {

Trajectory bent_track(std::span<const TimedPose> track_T_base, std::span<const TrackKnot> knots) {
  Trajectory bent;
  std::size_t next = 1, added = 0;
  const auto add_knots_until = [&](Stamp stamp) {
    for (; added < knots.size() && knots[added].stamp <= stamp; ++added)
      bent.add(knots[added].stamp, knots[added].map_T_base);
  };
  for (const TimedPose& at : track_T_base) {
    add_knots_until(at.stamp);
    while (next + 1 < knots.size() && knots[next].stamp < at.stamp) ++next;
    const TrackKnot& a = knots[next - 1];
    const Pose2 from_a = a.map_T_base * between(a.track_T_base, at.pose);
    if (knots.size() < 2 || at.stamp < a.stamp) {
      bent.add(at.stamp, from_a);
      continue;
    }
    const TrackKnot& b = knots[next];
    if (at.stamp >= b.stamp) {
      bent.add(at.stamp, b.map_T_base * between(b.track_T_base, at.pose));
      continue;
    }
    const Pose2 to_b = a.map_T_base * between(a.track_T_base, b.track_T_base);
    const double share = (at.stamp - a.stamp) / (b.stamp - a.stamp);
    bent.add(at.stamp, Pose2::from(from_a.position() + share * (b.map_T_base.position() - to_b.position()),
                                   from_a.yaw + share * angle_between(to_b.yaw, b.map_T_base.yaw)));
  }
  if (!knots.empty()) add_knots_until(knots.back().stamp);
  return bent;
}

}  // namespace mstsl
