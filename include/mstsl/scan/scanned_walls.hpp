#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/grid/grid.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/scan/wall_sample.hpp"

namespace mstsl {

/// A return, and the direction that its wall faces.
struct FacedPoint {
  Eigen::Vector2d point_m;
  Eigen::Vector2d normal;  ///< of length 1, to either side of the wall
};

/// The returns whose wall shows its direction: the line through the neighbours of each, none farther away
/// than `max_gap_m` or, where beams spread, three beam spacings. Lone returns and what is seen at a grazing
/// angle are left out. Expects returns in beam order.
std::vector<FacedPoint> faced_points(const std::vector<BeamReturn>& returns, double max_gap_m = 0.25);

/// Every point without its direction.
PointSet places_of(const std::vector<FacedPoint>& points);

struct ScannedWallsOptions {
  /// Points in one cell of this side (m) are one piece of wall, which lies at their mean.
  double cell_m = 0.10;
  /// Walls farther away than this (m) are not seen from a place.
  double reach_m = 0.5;
  /// Half the side of the square (m) that is kept.
  double half_size_m = 40.0;
};

/// Walls as scans have just shown them, for matching the next scan: pieces of wall, not cells, so that no
/// rounding adds up along a drive; a scan more costs what it adds. The same questions as WallField answers.
class ScannedWalls {
 public:
  explicit ScannedWalls(const Eigen::Vector2d& center_m, const ScannedWallsOptions& options = {});

  /// Adds a scan taken at a pose; what lies outside the square is left out.
  void add(const std::vector<FacedPoint>& points_base_m, const Pose2& map_T_base);

  /// At a map point; far from every wall (and outside the square) the distance is the reach and all else
  /// zero.
  WallSample sample(const Eigen::Vector2d& map_point_m) const;

  const Eigen::Vector2d& center_m() const { return center_m_; }
  double reach_m() const { return options_.reach_m; }
  bool empty() const { return pieces_.empty(); }

 private:
  struct Piece {
    Eigen::Vector2d sum_m{0, 0};
    Eigen::Vector3d facing{0, 0, 0};  ///< sum of n n^T: xx, xy, yy
    double count = 0.0;
    Eigen::Vector2d mean_m() const { return sum_m / count; }
  };
  void spread(std::int32_t piece);

  Eigen::Vector2d center_m_;
  ScannedWallsOptions options_;
  Grid<std::int32_t> piece_in_;  ///< of each cell, or -1
  Grid<std::int32_t> nearest_;   ///< of each cell's middle, or -1
  std::vector<Piece> pieces_;
};

}  // namespace mstsl
