#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/scan/likelihood_field.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

/// The likelihood field in 8 bits and, for each level h, the maximum over the 2^h x 2^h cells that begin at
/// each cell (Hess et al. 2016, Eq. 16): upper bounds on what any shift within such a block can score.
class LikelihoodPyramid {
 public:
  /// `levels` > 0 counts the finest one; a level more takes once more the field's memory (1 byte a cell).
  explicit LikelihoodPyramid(const LikelihoodField& field, int levels = 7);

  const GridGeometry& geometry() const { return geometry_; }
  int levels() const { return static_cast<int>(levels_.size()); }

  /// The largest value, 0 .. 255, over the cells from `cell` to `cell` + (2^level - 1); 0 where all lie
  /// outside.
  int at(int level, Cell cell) const {
    const Level& l = levels_[static_cast<std::size_t>(level)];
    const int column = cell.column + l.margin, row = cell.row + l.margin;
    if (column < 0 || row < 0 || column >= l.columns || row >= l.rows) return 0;
    return l.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(l.columns) +
                    static_cast<std::size_t>(column)];
  }

 private:
  /// Level 0 is the field itself; a coarser one begins `margin` cells before it, where windows first reach
  /// in.
  struct Level {
    int margin = 0;
    int columns = 0;
    int rows = 0;
    std::vector<std::uint8_t> values;
  };
  GridGeometry geometry_;
  std::vector<Level> levels_;
};

/// The poses to search: a box around `center`, its sides along the axes of the map's *grid*.
struct SearchWindow {
  Pose2 center;                                       ///< map_T_base
  Eigen::Vector2d reach_m = Eigen::Vector2d::Zero();  ///< to each side, along the grid's x and y
  double reach_rad = 0.0;                             ///< to each side; pi or more: every heading

  /// The box around the ellipsoid of so many standard deviations (the paper's 3 sigma) of a pose with the
  /// covariance of (x, y, yaw) in the map frame.
  static SearchWindow around(const Pose2& map_T_base, const Eigen::Matrix3d& covariance, double sigmas,
                             const GridGeometry& geometry);
  /// Every pose on the map.
  static SearchWindow whole(const GridGeometry& geometry);
};

struct PoseSearchOptions {
  /// Poses that score less are not looked for (0 .. 1).
  double min_score = 0.3;
  /// Answers closer together than this in both place and heading are one: only the best is given.
  double distinct_m = 0.5;
  double distinct_rad = 0.17;
  /// How many distinct answers at most.
  std::size_t max_answers = 1;
  /// Heading step (rad); 0: the largest that moves the farthest point by no more than a cell (Hess et al.,
  /// Eq. 7).
  double yaw_step_rad = 0.0;
};

struct ScoredPose {
  Pose2 map_T_base;
  double score = 0.0;  ///< mean likelihood of the points, 0 .. 1
};

/// The best poses on the lattice of whole cells and heading steps in the window, best first: exactly what
/// trying every one (with the same 8-bit field), sorting, and dropping those too near a better one would
/// give, by best-first branch and bound (Olson 2009; Hess et al. 2016, Sec. V). Empty when nothing reaches
/// min_score or there are no points.
std::vector<ScoredPose> search_poses(const LikelihoodPyramid& map, const PointSet& points_base_m,
                                     const SearchWindow& window, const PoseSearchOptions& options = {});

}  // namespace mstsl
