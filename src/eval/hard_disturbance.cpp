#include "hard_disturbance.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/eval/hard_protocol.hpp"

namespace mstsl {
namespace {

constexpr std::array kDisturbances{
    Disturbance{.name = "none"},
    Disturbance{.name = "heading", .heading = true},
    Disturbance{.name = "bias", .bias = true},
    Disturbance{.name = "motor", .motor = true},
    Disturbance{.name = "odometry", .odometry = true},
    Disturbance{.name = "people", .people = true},
    Disturbance{.name = "steel-moved", .steel = true},
    Disturbance{.name = "things-moved", .things = true},
    Disturbance{.name = "weak-field", .weak_field = true},
    Disturbance{.name = "sparse-survey", .sparse = true},
    Disturbance{.name = "tilt", .tilt = true},
    Disturbance{.name = "turn", .turn = true},
    Disturbance{.name = "all",
                .heading = true,
                .bias = true,
                .motor = true,
                .odometry = true,
                .people = true,
                .steel = true,
                .things = true,
                .weak_field = true,
                .sparse = true,
                .tilt = true},
    Disturbance{.name = "no-magnetometer", .heading = true, .odometry = true, .blind = true}};

constexpr double kMovedShare = 0.1;  // issue: 10 % since the survey

}  // namespace

std::vector<std::string> disturbance_names() {
  std::vector<std::string> names;
  for (const Disturbance& disturbance : kDisturbances) names.emplace_back(disturbance.name);
  return names;
}

std::optional<Disturbance> disturbance_by(std::string_view name) {
  const auto found = std::find_if(kDisturbances.begin(), kDisturbances.end(),
                                  [&](const Disturbance& disturbance) { return disturbance.name == name; });
  return found == kDisturbances.end() ? std::nullopt : std::optional(*found);
}

sim::RobotOptions robot_for(const Disturbance& disturbance, double scan_rate_hz, int beams,
                            const Random& random) {
  sim::RobotOptions robot;
  robot.lidar.rate_hz = scan_rate_hz;
  robot.lidar.beams = beams;
  robot.lidar.sweep_s = 0.75 / scan_rate_hz;  // 270 of the 360 deg of a turn, as the default's
  if (disturbance.tilt) {
    Random own = random;
    const double roll = own.uniform(-0.35, 0.35), pitch = own.uniform(-0.35, 0.35);
    robot.rig = sim::tilted_rig({roll, pitch, own.uniform(-kPi, kPi)});
  }
  if (disturbance.turn) robot.motion.initial_turn_rad = random.fork(1).uniform(-kPi, kPi);
  if (disturbance.bias) robot.magnetometer.bias_sigma_uT = 5.0;
  // Both motors' fields at the usual speed, where they point the same way: 5 uT.
  if (disturbance.motor) robot.magnetometer.motor_uT_per_m_s = 2.5 / robot.motion.speed_m_s;
  if (disturbance.blind) robot.magnetometer.rate_hz = 0.0;
  if (!disturbance.odometry) {
    robot.odometry.scale_sigma = 0.005;
    robot.odometry.drift_sigma_rad_per_m = radians(0.2);
    robot.odometry.slips_per_m = 0.0;
  }
  if (!disturbance.people) robot.people.per_100m = 0.0;
  return robot;
}

sim::World day_of(const sim::World& surveyed, const Disturbance& disturbance, const Random& random) {
  if (disturbance.things) return sim::on_another_day(surveyed, kMovedShare, random, sim::Change::kThings);
  if (disturbance.steel) return sim::on_another_day(surveyed, kMovedShare, random, sim::Change::kSteelOnly);
  return surveyed;
}

}  // namespace mstsl
