#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "mstsl/grid/frame.hpp"
#include "mstsl/magnetic/field_map.hpp"

namespace mstsl {

/// The field map as a filter wants it: mean, variance and slope at any place, fast, and something everywhere:
/// where the map says nothing, the mean of the whole map with the spread of the whole map as its variance. No
/// cell is less sure than that: between lanes beside steel a map may claim 60 +- 50 uT in a building whose
/// field is 50 +- 7 uT, and then the building is what counts, in the measure in which the map's variance is
/// above its.
class FieldSampler {
 public:
  explicit FieldSampler(const FieldMap& map);

  struct Sample {
    Eigen::Vector3d mean_uT;
    Eigen::Vector3d variance_uT2;            ///< of what a calibrated reading would show there
    Eigen::Matrix<double, 3, 2> slope_uT_m;  ///< by map x and y
    bool known = false;                      ///< false: the whole map's mean and spread
  };
  /// Bilinear between cell centres. Any point, also one that is not finite.
  Sample sample(const Eigen::Vector2d& map_point_m) const;

  /// Mean and standard deviation of each component over the supported cells: what is known of the field at a
  /// place about which nothing is known.
  const Eigen::Vector3d& mean_uT() const { return mean_uT_; }
  const Eigen::Vector3d& spread_uT() const { return spread_uT_; }
  /// How fast the field changes from place to place: the length (m) of a Matern 3/2 covariance with the map's
  /// own correlation at half a metre; between 0.3 and 3 m.
  double length_m() const { return length_m_; }

 private:
  struct Entry {
    Eigen::Vector3f mean_uT;
    Eigen::Vector3f variance_uT2;
  };
  void measure_spread(const FieldMap& map);
  void measure_length(const FieldMap& map);
  void fall_back_on_spread();
  Sample unknown() const;

  GridGeometry geometry_;
  GridFrame frame_;
  std::vector<Entry> entries_;  ///< NaN where the map has no value
  Eigen::Vector3d mean_uT_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d spread_uT_ = Eigen::Vector3d::Zero();
  double length_m_ = 1.0;
};

}  // namespace mstsl
