#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mstsl/sim/segment.hpp"

namespace mstsl::sim {

/// Where a ray meets the first segment.
struct RayHit {
  double range_m = 0.0;
  double cos_incidence = 1.0;  ///< cosine of the angle between the ray and the wall's normal, in [0, 1]
  std::size_t segment = 0;
};

/// Segments in the square buckets of a uniform grid, for exact ray casting and nearest distances.
class SegmentIndex {
 public:
  SegmentIndex() = default;
  /// `bucket_m`: side of a bucket; about the spacing of walls is best.
  explicit SegmentIndex(std::vector<Segment> segments, double bucket_m = 1.0);

  const std::vector<Segment>& segments() const { return segments_; }

  /// The first segment along the ray from `origin_m` in the unit direction `direction`, nearer than
  /// `max_range_m`.
  std::optional<RayHit> cast(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                             double max_range_m) const;

  /// Distance to the nearest segment, or `max_m` if all are farther.
  double clearance(const Eigen::Vector2d& point_m, double max_m) const;

  /// Whether the straight way from one point to the other crosses a segment.
  bool blocked(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const;

 private:
  std::size_t bucket(int column, int row) const;

  std::vector<Segment> segments_;
  Eigen::Vector2d corner_m_ = Eigen::Vector2d::Zero();
  double bucket_m_ = 1.0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_;    ///< bucket -> its first entry; one past the end closes the list
  std::vector<std::uint32_t> entries_;  ///< segment numbers, bucket by bucket
};

}  // namespace mstsl::sim
