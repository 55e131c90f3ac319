#pragma once

#include <vector>

#include <Eigen/Core>

#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl::datasets {

/// A field that somebody measured along one path: at a place it is the field of the path's nearest point,
/// linear between successive rows.
class PathField {
 public:
  /// Rows in the order they were walked; positions and fields in the map frame. Expects at least one.
  explicit PathField(std::vector<Fingerprint> rows);

  const std::vector<Fingerprint>& rows() const { return rows_; }
  Eigen::Vector3d field_uT(const Eigen::Vector2d& map_point_m) const;

 private:
  std::vector<Fingerprint> rows_;
};

}  // namespace mstsl::datasets
