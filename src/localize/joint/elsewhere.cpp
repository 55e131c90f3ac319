#include "mstsl/localize/joint/elsewhere.hpp"

#include <cmath>

#include "kalman.hpp"

namespace mstsl::joint {
namespace {

constexpr int kMean = kPose;

}  // namespace

Elsewhere::Elsewhere(const FieldSampler& field, const FieldModel& model)
    : model_(model), spread_uT_(field.spread_uT()), length_m_(field.length_m()) {
  const Eigen::Vector3d mean = field.mean_uT();
  // The mean field is the whole map's, turned by a heading that is not known.
  state_(kMean + 2) = mean.z();
  const double horizontal = 0.5 * mean.head<2>().squaredNorm() + square(spread_uT_.maxCoeff());
  covariance_.diagonal().segment<3>(kMean) << horizontal, horizontal, square(spread_uT_.z());
  covariance_.diagonal().segment<3>(kBias).setConstant(square(model.bias_sigma_uT));
  covariance_.diagonal().segment<3>(kMotor).setConstant(square(model.motor_sigma_uT));
}

double Elsewhere::update_by_field(const Station& station) {
  let_wander(state_, covariance_, station.since_last_m, length_m_, spread_uT_.cwiseAbs2());
  const Eigen::Matrix3d base_R_start = about_z(yaw_rad_ + station.base_T_then.yaw).transpose();
  Observation by_state = Observation::Zero();
  by_state.block<3, 3>(0, kMean) = base_R_start;
  by_state.block<3, 3>(0, kBias).setIdentity();
  by_state.block<3, 3>(0, kMotor) = station.speed_m_s * Eigen::Matrix3d::Identity();
  by_state.block<3, 3>(0, kMapError) = base_R_start;
  const Eigen::Vector3d off = station.base_field_uT - by_state * state_;
  const Eigen::Matrix3d noise =
      reading_variance(station, model_, news_of(station, model_)) * Eigen::Matrix3d::Identity();
  const Surprise surprise(by_state * covariance_ * by_state.transpose() + noise, off);
  state_ += correct(covariance_, by_state, surprise);
  return surprise.log_density();
}

}  // namespace mstsl::joint
