#include "mstsl/localize/field_witness.hpp"

#include <numeric>

#include <Eigen/Geometry>

namespace mstsl {

void FieldWitness::observe(const FieldSampler& field, const Eigen::Vector3d& base_field_uT,
                           const Pose2& map_T_base, const Eigen::Vector2d& sensor_base_m) {
  const FieldSampler::Sample mapped = field.sample(map_T_base * sensor_base_m);
  if (!mapped.known) return;
  const Eigen::Vector3d residual_uT =
      Eigen::AngleAxisd(map_T_base.yaw, Eigen::Vector3d::UnitZ()) * base_field_uT - mapped.mean_uT;
  const Eigen::Array3d variance_uT2 = mapped.variance_uT2.array() + options_.sigma_uT * options_.sigma_uT;
  deviations_.push_back((residual_uT.array().square() / variance_uT2).mean());
  if (deviations_.size() > options_.scans) deviations_.pop_front();
}

bool FieldWitness::agrees() const {
  if (2 * deviations_.size() < options_.scans) return false;
  const double sum = std::accumulate(deviations_.begin(), deviations_.end(), 0.0);
  return sum <= options_.agree_below * static_cast<double>(deviations_.size());
}

}  // namespace mstsl
