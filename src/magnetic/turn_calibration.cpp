#include "mstsl/magnetic/turn_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "mstsl/core/angles.hpp"

#include "ellipse_fit.hpp"
#include "turns.hpp"

namespace mstsl {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Of a building's field, horizontally: SD 5-13 uT over a correlation length of 0.4-3 m.
constexpr double kTypicalGradient_uT_m = 5.0;

using Parameters = Eigen::Vector<double, 6>;  ///< centre, how far the shape is from 1, lean

Parameters parameters_of(const TurnEllipse& e) {
  return {e.centre_uT.x(), e.centre_uT.y(), 0.5 * (e.shape(0, 0) - e.shape(1, 1)),
          e.shape(0, 1),   e.lean.x(),      e.lean.y()};
}

/// The jackknife's standard deviations: over turns where there are several, else over eighths of the circle.
/// What is left out together shares its errors.
Parameters standard_deviations(const std::vector<TurnSample>& samples, std::size_t turns) {
  constexpr std::size_t kFewestTurns = 4, kSectors = 8;
  const bool by_turn = turns >= kFewestTurns;
  const std::size_t groups = by_turn ? turns : kSectors;
  std::vector<Parameters> without;
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<TurnSample> rest;
    for (const TurnSample& s : samples)
      if ((by_turn ? s.turn : static_cast<std::size_t>(s.heading) * kSectors / kHeadings) != g)
        rest.push_back(s);
    if (const auto ellipse = fit_ellipse(rest, turns)) without.push_back(parameters_of(*ellipse));
  }
  if (without.size() < 2) return Parameters::Constant(std::numeric_limits<double>::infinity());
  const double n = static_cast<double>(without.size());
  const Parameters mean = std::accumulate(without.begin(), without.end(), Parameters(Parameters::Zero())) / n;
  Parameters sum = Parameters::Zero();
  for (const Parameters& p : without) sum += (p - mean).cwiseAbs2();
  return ((n - 1.0) / n * sum).cwiseSqrt();
}

/// The ellipse as a calibration of the sensor, whose axes the mounting turns.
MagnetometerCalibration in_sensor_axes(const TurnEllipse& ellipse, const Matrix3d& base_R_sensor) {
  Matrix3d base_soft = Matrix3d::Identity();
  base_soft.topLeftCorner<2, 2>() = ellipse.shape;
  base_soft.bottomLeftCorner<1, 2>() = -(ellipse.lean.transpose() * ellipse.shape);
  const Vector3d base_hard(ellipse.centre_uT.x(), ellipse.centre_uT.y(), 0.0);
  return {base_R_sensor.transpose() * base_hard, base_R_sensor.transpose() * base_soft * base_R_sensor};
}

void warn(TurnCalibration& result, double off_axis_m, double weakest_uT) {
  constexpr std::size_t kEnoughTurns = 4;
  constexpr double kPoor = 0.05, kOffAxis_m = 0.05;
  if (off_axis_m > kOffAxis_m && result.turns < kEnoughTurns)
    result.warnings.push_back(
        fmt::format("the magnetometer sits {:.2f} m from the axis of rotation, so a turn shows it more than "
                    "one place; turn at "
                    "{} places or more, some metres apart, and the differences average out",
                    off_axis_m, kEnoughTurns));
  if (result.corrected_uT > kPoor * weakest_uT)
    result.warnings.push_back(
        fmt::format("the horizontal field still changes by {:.1f} uT over a turn: something else moved or "
                    "drew current there",
                    result.corrected_uT));
}

}  // namespace

TurnCalibrator::TurnCalibrator(const Rig& rig, const TurnCalibrationOptions& options)
    : rig_(rig), options_(options) {}

void TurnCalibrator::observe(const OdometryReading& reading) {
  drives_.back().odom_T_base.add(reading.stamp, reading.odom_T_base);
}

void TurnCalibrator::observe(const FieldReading& reading) { drives_.back().readings.push_back(reading); }

void TurnCalibrator::restart() { drives_.emplace_back(); }

Result<TurnCalibration> TurnCalibrator::finish() const {
  const Matrix3d base_R_sensor = rig_.base_T_magnetometer.linear();
  std::vector<TurnSample> samples;
  TurnCalibration result;
  for (const Drive& drive : drives_)
    find_turns(drive.odom_T_base, drive.readings, base_R_sensor, options_, samples, result.turns);
  if (result.turns == 0)
    return Error(
        fmt::format("the robot nowhere turned through {:.0f} deg without moving more than {:.2f} m; let it "
                    "turn on the spot, "
                    "slowly, a full circle or more, best at four places some metres apart",
                    degrees(options_.covered_rad), options_.place_m));
  for (const TurnSample& sample : samples) result.readings += sample.readings;
  const auto ellipse = fit_ellipse(samples, result.turns);
  if (!ellipse)
    return Error(
        "the horizontal field over a turn draws no ellipse; is the sensor's mounting in the log right?");
  constexpr double kWeakest_uT = 3.0;  // the Earth's is 10 to 40 uT below 70 deg of latitude
  const double weakest_uT = strengths_uT(samples, result.turns, *ellipse).minCoeff();
  if (weakest_uT < kWeakest_uT)
    return Error(
        fmt::format("at one of the places the horizontal field is {:.1f} uT, too weak to tell its circle's "
                    "centre from its edge; turn elsewhere",
                    weakest_uT));
  const double off_axis_m = rig_.base_T_magnetometer.translation().head<2>().norm();
  const Parameters sd = standard_deviations(samples, result.turns);
  // Off the axis a horizontally diverging field looks like hard iron; turns at many places show that by
  // themselves.
  const double gradient_uT =
      off_axis_m * kTypicalGradient_uT_m / std::sqrt(static_cast<double>(result.turns));
  const Vector3d base_sd(std::hypot(sd(0), gradient_uT), std::hypot(sd(1), gradient_uT), 0.0);
  result.calibration = in_sensor_axes(*ellipse, base_R_sensor);
  result.hard_iron_sd_uT = (base_R_sensor.transpose().cwiseAbs2() * base_sd.cwiseAbs2()).cwiseSqrt();
  result.soft_iron_sd = sd.tail<4>().maxCoeff();
  result.uncorrected_uT = strength_change_uT(samples, result.turns, TurnEllipse{});
  result.corrected_uT = strength_change_uT(samples, result.turns, *ellipse);
  warn(result, off_axis_m, weakest_uT);
  return result;
}

}  // namespace mstsl
