#include "mstsl/localize/joint/mode.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "mstsl/core/angles.hpp"
#include "mstsl/localize/motion.hpp"

#include "kalman.hpp"

namespace mstsl::joint {
namespace {

Eigen::Vector3d constant(double value) { return Eigen::Vector3d::Constant(value); }
void shift_pose(Mode& mode, Vector change) {
  mode.map_T_base =
      Pose2::from(mode.map_T_base.position() + change.head<2>(), mode.map_T_base.yaw + change(2));
  change.head<3>().setZero();
  mode.state += change;
}

/// A station as a mode sees it: what it expects, and how that changes with the state.
struct Expected {
  Eigen::Vector3d without_map_error_uT;
  Observation by_state;
  Eigen::Vector3d error_variance_uT2;
  double unmapped;  ///< 0: the map tells the field here; 1: no more than who knows the building
};

Expected expect(const Mode& mode, const Station& station, const FieldSampler& field,
                const Eigen::Vector2d& magnetometer_m, const FieldModel& model) {
  const Pose2 then = mode.map_T_base * station.base_T_then;
  const Eigen::Vector2d place = then * magnetometer_m;
  const FieldSampler::Sample here = field.sample(place);
  const Eigen::Matrix3d base_R_map = about_z(then.yaw).transpose();
  const Eigen::Vector3d field_uT = here.mean_uT + mode.state.segment<3>(kMapError);
  const Eigen::Vector2d arm = place - mode.map_T_base.position();

  Expected e;
  e.without_map_error_uT = base_R_map * here.mean_uT + mode.state.segment<3>(kBias) +
                           station.speed_m_s * mode.state.segment<3>(kMotor);
  e.by_state.setZero();
  e.by_state.block<3, 2>(0, kPose) = base_R_map * here.slope_uT_m;
  // Turning the robot turns its axes against the field, and swings the sensor about the base.
  const Eigen::Vector3d turned = base_R_map * Eigen::Vector3d(field_uT.y(), -field_uT.x(), 0);
  e.by_state.col(kPose + 2) = turned + base_R_map * here.slope_uT_m * Eigen::Vector2d(-arm.y(), arm.x());
  e.by_state.block<3, 3>(0, kBias).setIdentity();
  e.by_state.block<3, 3>(0, kMotor) = station.speed_m_s * Eigen::Matrix3d::Identity();
  e.by_state.block<3, 3>(0, kMapError) = base_R_map;
  const Eigen::Vector3d claimed = square(model.map_error_factor) * here.variance_uT2;
  e.error_variance_uT2 =
      here.known
          ? Eigen::Vector3d(claimed.cwiseMin(field.spread_uT().cwiseAbs2()).cwiseMax(here.variance_uT2) +
                            constant(square(model.map_error_floor_uT)))
          : here.variance_uT2;
  // In a building whose field is the same everywhere nothing is left to be mapped.
  const double spread_uT2 = field.spread_uT().squaredNorm();
  e.unmapped = spread_uT2 > 0.0 ? std::clamp(here.variance_uT2.sum() / spread_uT2, 0.0, 1.0) : 0.0;
  return e;
}

}  // namespace

Mode make_mode(const Pose2& map_T_base, const Eigen::Matrix3d& pose_covariance, const FieldModel& model) {
  Mode mode{map_T_base};
  mode.covariance.topLeftCorner<3, 3>() = pose_covariance;
  mode.covariance.diagonal().segment<3>(kBias).setConstant(square(model.bias_sigma_uT));
  mode.covariance.diagonal().segment<3>(kMotor).setConstant(square(model.motor_sigma_uT));
  return mode;
}

void predict(Mode& mode, const Pose2& last_T_base, const Eigen::Matrix3d& motion_covariance,
             double bias_walk_uT) {
  const Eigen::Matrix3d by_pose = by_pose_before(mode.map_T_base, last_T_base);
  Covariance& p = mode.covariance;
  p.topRows<3>() = (by_pose * p.topRows<3>()).eval();
  p.leftCols<3>() = (p.leftCols<3>() * by_pose.transpose()).eval();
  p.topLeftCorner<3, 3>() += in_map(mode.map_T_base, motion_covariance);
  p.diagonal().segment<3>(kBias).array() += square(bias_walk_uT) * last_T_base.position().norm();
  mode.map_T_base = mode.map_T_base * last_T_base;
}

void ErrorScale::learn(double squared, double way_m, double length_m, double news) {
  constexpr double kMost = 30.0;  // one wild station is one, not a rule
  const double kept = std::exp(-way_m / length_m);
  const ErrorScale before;
  weight = before.weight + kept * (weight - before.weight) + 3.0 * news;
  squares = before.squares + kept * (squares - before.squares) + std::min(squared, kMost) * news;
}

double update_by_field(Mode& mode, const Station& station, const FieldSampler& field,
                       const Eigen::Vector2d& magnetometer_m, const FieldModel& model) {
  const Expected e = expect(mode, station, field, magnetometer_m, model);
  const Eigen::Matrix3d base_R_map = e.by_state.block<3, 3>(0, kMapError);
  // Where the map is worse than it claims, its error is larger and has to be followed; where it is better,
  // the claim stands, and only what it expects of a station is less.
  const double worse = std::max(1.0, mode.scale.factor());
  // Where the sensor hardly moved the map is off by what it was off by before: nothing new is told of the
  // map.
  const double news = news_of(station, model);
  const double better = std::lerp(1.0, std::min(1.0, mode.scale.factor()), news);
  const Eigen::Vector3d error_uT2 = worse * e.error_variance_uT2;
  // Where the map knows nothing its error is the field itself: as smooth, and changing as fast.
  const Eigen::Vector3d own_uT2 = news * model.error_own_share * (1.0 - e.unmapped) * e.error_variance_uT2;
  const double length_m = std::lerp(model.error_length_m, field.length_m(), e.unmapped);
  const Eigen::Matrix3d noise = reading_variance(station, model, news) * Eigen::Matrix3d::Identity() +
                                base_R_map * own_uT2.asDiagonal() * base_R_map.transpose();

  // Where the map is good its error wanders on; where steel was moved it is anything, and goes on from there.
  Mode mapped = mode, changed = mode;
  let_wander(mapped.state, mapped.covariance, station.since_last_m, length_m, error_uT2 - own_uT2);
  const Eigen::Vector3d anything = field.spread_uT().cwiseAbs2() + e.error_variance_uT2;
  if (mode.changed > 0.5)
    let_wander(changed.state, changed.covariance, station.since_last_m, field.length_m(), anything);
  else
    forget_map_error(changed.state, changed.covariance, anything);
  const auto surprise = [&](const Mode& m) {
    const Eigen::Vector3d off =
        station.base_field_uT - e.without_map_error_uT - base_R_map * m.state.segment<3>(kMapError);
    return Surprise(e.by_state * m.covariance * e.by_state.transpose() + noise, off);
  };
  const Surprise as_mapped = surprise(mapped), as_changed = surprise(changed);

  const double way_m = std::clamp(station.since_last_m, 1e-3, 1.0);
  const double begins = 1.0 - std::exp(-way_m / model.change_every_m),
               lasts = std::exp(-way_m / model.change_length_m);
  const double chance = mode.changed * lasts + (1.0 - mode.changed) * begins;
  const double if_mapped = std::log1p(-chance) + as_mapped.log_density(better);
  const double if_changed = std::log(chance) + as_changed.log_density();
  const double more = std::max(if_mapped, if_changed), less = std::min(if_mapped, if_changed);
  const double log_density = more + std::log1p(std::exp(less - more));
  Mode& likelier = if_changed > if_mapped ? changed : mapped;
  shift_pose(likelier,
             correct(likelier.covariance, e.by_state, if_changed > if_mapped ? as_changed : as_mapped));
  likelier.changed = std::exp(if_changed - log_density);
  likelier.scale.learn(if_changed > if_mapped ? 3.0 : worse * as_mapped.squared, way_m, model.scale_length_m,
                       news);
  mode = likelier;
  return log_density;
}

void reseat(Mode& mode, const WallFit& fit, const Eigen::Matrix3d& pose_covariance, double loosen_uT) {
  mode.map_T_base = fit.map_T_base;
  mode.covariance.topRows<3>().setZero();
  mode.covariance.leftCols<3>().setZero();
  mode.covariance.topLeftCorner<3, 3>() = pose_covariance;
  mode.covariance.diagonal().segment<3>(kBias).array() += square(loosen_uT);
}

void update_by_scan(Mode& mode, const WallFit& fit) {
  const Eigen::Matrix3d prior = mode.pose_covariance();
  // P - P_p (P_pp + Lambda^-1)^-1 P_p^T, written so that a scan which leaves a direction open may do so.
  const Eigen::Matrix3d shrink =
      fit.information * (Eigen::Matrix3d::Identity() + prior * fit.information).inverse();
  const Eigen::Matrix<double, kStates, 3> cross = mode.covariance.leftCols<3>();
  const Eigen::Vector3d moved = difference(mode.map_T_base, fit.map_T_base);
  shift_pose(mode, cross * prior.ldlt().solve(moved));
  mode.map_T_base = fit.map_T_base;
  mode.covariance.noalias() -= cross * (0.5 * (shrink + shrink.transpose())) * cross.transpose();
  mode.covariance = (0.5 * (mode.covariance + mode.covariance.transpose())).eval();
}

}  // namespace mstsl::joint
