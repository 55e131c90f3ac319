#include "mstsl/eval/simulated_survey.hpp"

#include <cmath>
#include <cstdint>

#include "mstsl/magnetic/fingerprint_collector.hpp"
#include "mstsl/sim/drive.hpp"

namespace mstsl {
namespace {

/// An error of position that wanders about zero (Ornstein and Uhlenbeck's process over the way driven).
class WanderingError {
 public:
  WanderingError(double sigma_m, double length_m, const Random& random)
      : sigma_m_(sigma_m), length_m_(length_m), random_(random) {
    error_m_ = sigma_m_ * draw();
  }

  Pose2 applied_to(const Pose2& true_pose) {
    if (last_) {
      const double kept = std::exp(-distance(*last_, true_pose) / length_m_);
      error_m_ = kept * error_m_ + std::sqrt(1.0 - kept * kept) * sigma_m_ * draw();
    }
    last_ = true_pose;
    return Pose2::from(true_pose.position() + error_m_, true_pose.yaw);
  }

 private:
  Eigen::Vector2d draw() {
    const double x = random_.normal();
    return {x, random_.normal()};
  }
  double sigma_m_, length_m_;
  Random random_;
  Eigen::Vector2d error_m_ = Eigen::Vector2d::Zero();
  std::optional<Pose2> last_;
};

std::vector<Fingerprint> collect(const sim::World& world, const sim::Route& route,
                                 const SimulatedSurveyOptions& options, const Random& random) {
  constexpr std::uint64_t kDrive = 1, kPositions = 2;
  sim::RobotOptions robot = options.robot;
  robot.lidar.rate_hz = 0.0;  // nobody looks at its scans
  FingerprintCollector collector(robot.rig, {.spacing_m = options.survey.fingerprint_spacing_m});
  WanderingError error(options.position_sigma_m, options.position_error_length_m, random.fork(kPositions));
  const sim::DriveSinks sinks{
      [&](const SensorEvent& event) {
        if (const auto* field = std::get_if<FieldReading>(&event)) collector.observe(*field);
      },
      [&](const PoseReading& truth) {
        collector.observe(PoseReading{truth.stamp, error.applied_to(truth.map_T_base)});
      }};
  sim::drive(world, robot, route, Stamp{}, random.fork(kDrive), sinks, options.field);
  return collector.finish();
}

}  // namespace

Result<std::vector<Fingerprint>> simulate_survey(const sim::World& world,
                                                 const SimulatedSurveyOptions& options,
                                                 const Random& random) {
  const Result<std::vector<sim::Route>> routes = sim::survey_routes(world, options.survey);
  if (!routes) return routes.error();
  std::vector<std::vector<Fingerprint>> logs(routes->size());
  parallel_for(logs.size(), options.threads,
               [&](std::size_t i) { logs[i] = collect(world, (*routes)[i], options, random.fork(i)); });
  std::vector<Fingerprint> all;
  for (std::size_t i = 0; i < logs.size(); ++i)
    for (Fingerprint& fingerprint : logs[i]) {
      fingerprint.session = static_cast<int>(i);
      all.push_back(fingerprint);
    }
  return all;
}

}  // namespace mstsl
