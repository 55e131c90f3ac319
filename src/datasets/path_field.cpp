#include "mstsl/datasets/path_field.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

namespace mstsl::datasets {

PathField::PathField(std::vector<Fingerprint> rows) : rows_(std::move(rows)) { assert(!rows_.empty()); }

Eigen::Vector3d PathField::field_uT(const Eigen::Vector2d& map_point_m) const {
  double nearest_m2 = (rows_.front().position_m - map_point_m).squaredNorm();
  Eigen::Vector3d field_uT = rows_.front().field_uT;
  for (std::size_t i = 0; i + 1 < rows_.size(); ++i) {
    const Eigen::Vector2d step = rows_[i + 1].position_m - rows_[i].position_m;
    const Eigen::Vector2d to_point = map_point_m - rows_[i].position_m;
    const double length_m2 = step.squaredNorm();
    const double share = length_m2 > 0.0 ? std::clamp(to_point.dot(step) / length_m2, 0.0, 1.0) : 0.0;
    const double apart_m2 = (to_point - share * step).squaredNorm();
    if (apart_m2 >= nearest_m2) continue;
    nearest_m2 = apart_m2;
    field_uT = (1.0 - share) * rows_[i].field_uT + share * rows_[i + 1].field_uT;
  }
  return field_uT;
}

}  // namespace mstsl::datasets
