#include "mstsl/eval/trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

constexpr double kApart_m = 1.0, kLoop_m = 10.0;

/// Way driven by each pose, along the true one.
std::vector<double> ways_of(std::span<const Pose2> truth) {
  std::vector<double> ways_m(truth.size(), 0.0);
  for (std::size_t i = 1; i < truth.size(); ++i) ways_m[i] = ways_m[i - 1] + distance(truth[i - 1], truth[i]);
  return ways_m;
}

class Relations {
 public:
  void add(const TimedPose& a, const TimedPose& b, const Pose2& true_a, const Pose2& true_b) {
    const Pose2 error = between(between(true_a, true_b), between(a.pose, b.pose));
    translation_m_.push_back(std::hypot(error.x, error.y));
    rotation_deg_.push_back(std::abs(degrees(error.yaw)));
  }
  RelationErrors errors() const { return {spread_of(translation_m_), spread_of(rotation_deg_)}; }

 private:
  std::vector<double> translation_m_, rotation_deg_;
};

}  // namespace

TrajectoryError trajectory_error(std::span<const TimedPose> estimated, std::span<const Pose2> truth) {
  const auto n = static_cast<double>(estimated.size());
  Eigen::Vector2d mean_estimated(0, 0), mean_true(0, 0);
  for (std::size_t i = 0; i < estimated.size(); ++i)
    mean_estimated += estimated[i].pose.position() / n, mean_true += truth[i].position() / n;
  double cosine = 0.0, sine = 0.0;
  for (std::size_t i = 0; i < estimated.size(); ++i) {
    const Eigen::Vector2d e = estimated[i].pose.position() - mean_estimated,
                          t = truth[i].position() - mean_true;
    cosine += e.dot(t), sine += e.x() * t.y() - e.y() * t.x();
  }
  TrajectoryError error;
  const double yaw = std::atan2(sine, cosine);
  error.true_T_map = Pose2::from(mean_true - Eigen::Rotation2Dd(yaw) * mean_estimated, yaw);
  for (std::size_t i = 0; i < estimated.size(); ++i) {
    const double off_m = (error.true_T_map * estimated[i].pose.position() - truth[i].position()).norm();
    error.rms_m += off_m * off_m / n;
    error.max_m = std::max(error.max_m, off_m);
  }
  error.rms_m = std::sqrt(error.rms_m);
  return error;
}

RelationErrors local_errors(std::span<const TimedPose> estimated, std::span<const Pose2> truth) {
  const std::vector<double> ways_m = ways_of(truth);
  Relations relations;
  for (std::size_t i = 0, k = 0; i < truth.size(); ++i) {
    while (k < truth.size() && ways_m[k] - ways_m[i] < kApart_m) ++k;
    if (k < truth.size()) relations.add(estimated[i], estimated[k], truth[i], truth[k]);
  }
  return relations.errors();
}

RelationErrors loop_errors(std::span<const TimedPose> estimated, std::span<const Pose2> truth) {
  const std::vector<double> ways_m = ways_of(truth);
  Relations relations;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    std::size_t nearest = truth.size();
    double least_m = kApart_m;
    for (std::size_t k = i + 1; k < truth.size(); ++k)
      if (ways_m[k] - ways_m[i] >= kLoop_m && distance(truth[i], truth[k]) < least_m)
        least_m = distance(truth[i], truth[k]), nearest = k;
    if (nearest < truth.size()) relations.add(estimated[i], estimated[nearest], truth[i], truth[nearest]);
  }
  return relations.errors();
}

}  // namespace mstsl
