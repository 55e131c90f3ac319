#include "mstsl/sim/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mstsl::sim {

using Eigen::Vector2d;

Pose2 Trajectory::at(double seconds_from_start) const {
  if (poses.empty()) return {};
  const double at = std::clamp(seconds_from_start / step_s, 0.0, static_cast<double>(poses.size() - 1));
  const auto before = std::min(static_cast<std::size_t>(at), poses.size() - 1);
  const auto after = std::min(before + 1, poses.size() - 1);
  return interpolate(poses[before], poses[after], at - static_cast<double>(before));
}

double length(const Trajectory& trajectory) {
  double sum = 0.0;
  for (std::size_t i = 1; i < trajectory.poses.size(); ++i)
    sum += distance(trajectory.poses[i - 1], trajectory.poses[i]);
  return sum;
}

namespace {

/// A line through points, asked by its length.
class MeasuredLine {
 public:
  explicit MeasuredLine(const std::vector<Vector2d>& points_m) {
    for (const Vector2d& point : points_m) {
      const double step = points_.empty() ? 0.0 : (point - points_.back()).norm();
      if (!points_.empty() && step == 0.0) continue;
      reached_m_.push_back(points_.empty() ? 0.0 : reached_m_.back() + step);
      points_.push_back(point);
    }
  }
  double length_m() const { return reached_m_.empty() ? 0.0 : reached_m_.back(); }
  Vector2d at(double along_m) const {
    const auto after = std::upper_bound(reached_m_.begin(), reached_m_.end(), along_m) - reached_m_.begin();
    if (after == 0) return points_.front();
    const auto i = static_cast<std::size_t>(after);
    if (i == points_.size()) return points_.back();
    return points_[i - 1] + (points_[i] - points_[i - 1]) *
                                ((along_m - reached_m_[i - 1]) / (reached_m_[i] - reached_m_[i - 1]));
  }

 private:
  std::vector<Vector2d> points_;
  std::vector<double> reached_m_;
};

}  // namespace

Trajectory along_points(const std::vector<Vector2d>& points_m, const MotionOptions& motion,
                        double heading_window_m, Stamp start) {
  Trajectory trajectory{start, 0.01, {}};
  const MeasuredLine line(points_m);
  if (points_m.empty()) return trajectory;
  const double step_m = motion.speed_m_s * trajectory.step_s;
  const auto steps = static_cast<std::size_t>(line.length_m() / step_m);
  double yaw = 0.0;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double along = static_cast<double>(i) * step_m;
    const Vector2d ahead = line.at(along + 0.5 * heading_window_m) - line.at(along - 0.5 * heading_window_m);
    if (ahead.norm() > 0) yaw = std::atan2(ahead.y(), ahead.x());
    trajectory.poses.push_back(Pose2::from(line.at(along), yaw));
  }
  return trajectory;
}

}  // namespace mstsl::sim
