#include "mstsl/localize/align.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Geometry>

#include "mstsl/core/angles.hpp"

namespace mstsl {

bool FirstReading::in_one_place(const Pose2& a, const Pose2& b) const {
  return distance(a, b) <= options_.still_m && std::abs(angle_between(a.yaw, b.yaw)) <= options_.still_rad;
}

void FirstReading::note_motion(Stamp stamp, const Pose2& track_T_base) {
  if (!track_T_start_) {
    track_T_start_ = track_T_base;
    rest_ = {stamp, track_T_base};
    now_ = stamp;
  }
  if (!in_one_place(rest_.pose, track_T_base)) rest_ = {stamp, track_T_base};
  if (distance(*track_T_start_, track_T_base) > options_.drive_off_m) driven_off_ = true;
  now_ = std::max(now_, stamp);
}

void FirstReading::observe_scan(Stamp stamp, const PointSet& points_base_m, const Pose2& track_T_base,
                                Random& random) {
  note_motion(stamp, track_T_base);
  // While it turns there will be a better scan; while it stands one is enough.
  const bool stands = track_T_last_scan_ && in_one_place(*track_T_last_scan_, track_T_base);
  const bool new_place = lines_.empty() || !in_one_place(lines_.back().track_T_base, track_T_base);
  track_T_last_scan_ = track_T_base;
  if (!lines_.empty() && !(new_place && (stands || driven_off_))) return;
  const std::optional<LineFit> line = fit_line(points_base_m, options_.line, random);
  if (!line) return;
  lines_.push_back({track_T_base, turn_parallel_to(*line)});
  if (!beta_rad_) beta_rad_ = lines_.back().beta_rad;
}

void FirstReading::observe_field(Stamp stamp, const Eigen::Vector3d& base_field_uT,
                                 const Pose2& track_T_base) {
  note_motion(stamp, track_T_base);
  samples_.push_back({stamp, track_T_base, base_field_uT});
  while (stamp - samples_.front().stamp > options_.memory_s) samples_.pop_front();
}

bool FirstReading::done_waiting() const { return driven_off_ || now_ - rest_.stamp >= options_.patience_s; }

double FirstReading::duration_s(const Stay& stay) const {
  return samples_[stay.end - 1].stamp - samples_[stay.first].stamp;
}

/// The last stay that deserves the name; if the robot never stood, the one with the most readings.
FirstReading::Stay FirstReading::best_stay() const {
  Stay best;
  for (std::size_t first = 0, end; first < samples_.size(); first = end) {
    for (end = first + 1; end < samples_.size(); ++end)
      if (!in_one_place(samples_[first].track_T_base, samples_[end].track_T_base)) break;
    const Stay stay{first, end};
    const bool stood = duration_s(stay) >= options_.min_stay_s;
    const bool best_stood = best.size() > 0 && duration_s(best) >= options_.min_stay_s;
    if (stood || (!best_stood && stay.size() >= best.size())) best = stay;
  }
  return best;
}

AlignedReading FirstReading::align(const Stay& stay) const {
  AlignedReading aligned;
  const Sample& last = samples_[stay.end - 1];
  aligned.stamp = last.stamp;
  aligned.track_T_base = last.track_T_base;
  aligned.readings = stay.size();
  aligned.beta_rad = *beta_rad_;
  // The line seen from nearest by makes up for slip while turning.
  const auto nearest =
      std::min_element(lines_.begin(), lines_.end(), [&](const SeenLine& a, const SeenLine& b) {
        const auto apart = [&](const SeenLine& line) {
          return distance(line.track_T_base, last.track_T_base) +
                 std::abs(angle_between(line.track_T_base.yaw, last.track_T_base.yaw));
        };
        return apart(a) < apart(b);
      });
  const double turned_rad = angle_between(nearest->track_T_base.yaw, last.track_T_base.yaw);
  aligned.aligned_yaw_rad = wrap_angle(turned_rad - nearest->beta_rad);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = stay.first; i < stay.end; ++i) sum += samples_[i].base_field_uT;
  aligned.field_uT = Eigen::AngleAxisd(aligned.aligned_yaw_rad, Eigen::Vector3d::UnitZ()) *
                     Eigen::Vector3d(sum / static_cast<double>(stay.size()));
  return aligned;
}

std::optional<AlignedReading> FirstReading::take() const {
  if (lines_.empty() || samples_.empty() || !done_waiting()) return std::nullopt;
  return align(best_stay());
}

}  // namespace mstsl
