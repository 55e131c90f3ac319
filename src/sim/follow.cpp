#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/sim/trajectory.hpp"

/// The robot's driver: stands, turns in place, and tracks a line by pure pursuit (Coulter 1992).
namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

constexpr double kStep_s = 0.01;
constexpr double kLookahead_m = 0.5;
/// Corners sharper than this are turned standing.
constexpr double kSharpCorner_rad = radians(50.0);
constexpr double kArrived_m = 0.01;

double heading(const Vector2d& from, const Vector2d& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

/// A line that is driven without stopping.
struct Stretch {
  std::vector<Vector2d> points_m;

  double length_m() const {
    double sum = 0.0;
    for (std::size_t i = 1; i < points_m.size(); ++i) sum += (points_m[i] - points_m[i - 1]).norm();
    return sum;
  }
  /// The point so far along, on the last leg's extension beyond the end, and the way it runs there.
  Pose2 at(double along_m) const {
    std::size_t leg = 1;
    double left_m = along_m;
    for (; leg + 1 < points_m.size(); ++leg) {
      const double leg_m = (points_m[leg] - points_m[leg - 1]).norm();
      if (left_m < leg_m) break;
      left_m -= leg_m;
    }
    const double yaw = heading(points_m[leg - 1], points_m[leg]);
    return Pose2::from(points_m[leg - 1] + left_m * Vector2d(std::cos(yaw), std::sin(yaw)), yaw);
  }
};

/// Cuts a route where it turns sharply.
std::vector<Stretch> stretches_of(const Route& route) {
  std::vector<Stretch> stretches;
  for (const Vector2d& point : route.waypoints_m) {
    if (stretches.empty()) {
      stretches.push_back({{point}});
      continue;
    }
    std::vector<Vector2d>& points = stretches.back().points_m;
    if ((point - points.back()).norm() < kArrived_m) continue;
    if (points.size() > 1) {
      const double corner =
          angle_between(heading(points[points.size() - 2], points.back()), heading(points.back(), point));
      if (std::abs(corner) > kSharpCorner_rad) {
        stretches.push_back({{points.back(), point}});
        continue;
      }
    }
    points.push_back(point);
  }
  if (!stretches.empty() && stretches.back().points_m.size() < 2) stretches.pop_back();
  return stretches;
}

class Driver {
 public:
  Driver(const Pose2& start, const MotionOptions& motion, const Random& random, std::vector<Pose2>& poses)
      : pose_(start), motion_(motion), random_(random), poses_(poses) {
    wander_m_ = motion.wander_m * random_.normal();
    poses_.push_back(pose_);
  }

  void stand(double seconds) {
    for (double t = 0.0; t < seconds - 0.5 * kStep_s; t += kStep_s) poses_.push_back(pose_);
  }

  void turn(double angle_rad) {
    const double sign = angle_rad < 0 ? -1.0 : 1.0;
    double left = std::abs(angle_rad), rate = 0.0;
    while (left > 1e-6) {
      rate = std::min({rate + motion_.turn_acceleration_rad_s2 * kStep_s, motion_.turn_rate_rad_s,
                       std::sqrt(2.0 * motion_.turn_acceleration_rad_s2 * left) + 1e-3});
      const double step = std::min(left, rate * kStep_s);
      left -= step;
      move(0.0, sign * step);
    }
  }

  void track(const Stretch& stretch) {
    const double whole_m = stretch.length_m();
    const Pose2 last = stretch.at(whole_m);
    turn(angle_between(pose_.yaw, target_heading(stretch, 0.0)));
    double along_m = 0.0, speed = 0.0;
    while (true) {
      // After cut corners the robot may be further on than it counted: the point it heads for is in front of
      // it.
      while (along_m < whole_m && too_near(stretch, along_m)) along_m += kArrived_m;
      // How much is left is measured along the last leg near the end, by the driven length before.
      const double to_end_m =
          whole_m - along_m < kLookahead_m ? -(inverse(last) * pose_.position()).x() : whole_m - along_m;
      if (to_end_m < kArrived_m) return;
      const double error = angle_between(pose_.yaw, target_heading(stretch, along_m));
      if (std::abs(error) > kSharpCorner_rad) {  // thrown off its line: stops and faces it again
        turn(error);
        speed = 0.0;
        continue;
      }
      const double curvature = 2.0 * std::sin(error) / kLookahead_m;
      const double wanted =
          std::min({motion_.speed_m_s, std::sqrt(2.0 * motion_.acceleration_m_s2 * to_end_m) + 1e-3,
                    motion_.turn_rate_rad_s / std::max(std::abs(curvature), 1e-9)});
      const double change = motion_.acceleration_m_s2 * kStep_s;
      speed = std::clamp(wanted, speed - 2.0 * change, speed + change);
      const double step_m = speed * kStep_s;
      move(step_m, step_m * curvature);
      along_m += step_m * std::cos(angle_between(stretch.at(along_m).yaw, pose_.yaw));
      wander(step_m);
    }
  }

 private:
  Vector2d target(const Stretch& stretch, double along_m) const {
    return stretch.at(along_m + kLookahead_m) * Vector2d(0.0, wander_m_);
  }
  double target_heading(const Stretch& stretch, double along_m) const {
    return heading(pose_.position(), target(stretch, along_m));
  }
  bool too_near(const Stretch& stretch, double along_m) const {
    return (target(stretch, along_m) - pose_.position()).norm() < 0.4 * kLookahead_m;
  }

  /// A first-order Gauss-Markov process over the distance driven.
  void wander(double step_m) {
    const double keep = std::exp(-step_m / motion_.wander_length_m);
    wander_m_ = keep * wander_m_ + std::sqrt(1.0 - keep * keep) * motion_.wander_m * random_.normal();
  }

  void move(double forward_m, double turn_rad) {
    // Along the chord of the arc: exact for constant speeds to second order.
    const double chord_yaw = pose_.yaw + 0.5 * turn_rad;
    pose_ = Pose2::from(pose_.position() + forward_m * Vector2d(std::cos(chord_yaw), std::sin(chord_yaw)),
                        pose_.yaw + turn_rad);
    poses_.push_back(pose_);
  }

  Pose2 pose_;
  MotionOptions motion_;
  Random random_;
  std::vector<Pose2>& poses_;
  double wander_m_ = 0.0;
};

}  // namespace

Trajectory follow(const Route& route, const MotionOptions& motion, Stamp start, const Random& random) {
  Trajectory trajectory{start, kStep_s, {}};
  if (route.waypoints_m.empty()) return trajectory;
  Driver driver(Pose2::from(route.waypoints_m.front(), route.start_yaw_rad), motion, random,
                trajectory.poses);
  driver.stand(motion.standstill_s);
  if (motion.initial_turn_rad != 0.0) {
    driver.turn(motion.initial_turn_rad);
    driver.stand(motion.standstill_s);
  }
  for (const Stretch& stretch : stretches_of(route)) driver.track(stretch);
  return trajectory;
}

}  // namespace mstsl::sim
