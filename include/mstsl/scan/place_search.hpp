#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/fit_to_walls.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/scan/score_bounds.hpp"
#include "mstsl/scan/wall_field.hpp"

namespace mstsl {

struct PlaceSearchOptions {
  /// The largest blocks of poses: side in m, and headings in rad. They are halved twice.
  double block_m = 0.4;
  double block_rad = radians(3.0);
  /// Places within this of a wall (m) are none: even the middle of a small robot keeps off that far.
  double clearance_m = 0.1;
  /// Only returns within this range (m) are used: a block of headings moves a point the more the farther it
  /// is.
  double max_range_m = 12.0;
  double spacing_m = 0.3;  ///< points nearer each other count once
  std::size_t max_points = 60;
  /// Fewer points than this do not tell one place from another.
  std::size_t min_points = 12;
  /// Places that score (WallFit::score) this much less than the best, or less than min_score, are left out.
  /// 0.35: people and moved things hide up to a third of a scan at the right place.
  double below_best = 0.35;
  double min_score = 0.3;
  /// A fit may score this much more than the middle of the smallest block that it begins in: a point 12 m
  /// away moves by 0.15 m there, near ones by 0.07 m.
  double fit_gains = 0.25;
  /// Answers closer together than this in both place and heading are one.
  double distinct_m = 0.2;
  double distinct_rad = radians(3.0);
  /// No more fits than this are made, the most promising ones first.
  std::size_t max_fits = 20'000;
  FitOptions fit = {};
};

/// Where a scan may have been taken.
struct FoundPlaces {
  std::vector<WallFit> fits;  ///< best first
  bool complete = true;       ///< false: max_fits cut it short
  bool informative = true;    ///< false: too few points to search with; `fits` is empty
};

/// Lists all poses, over the whole free space and all headings, at which a scan fits nearly as well as at the
/// best, however many there are: a corridor gives hundreds. Branch and bound (after Hess et al. 2016) with
/// the bounds of ScoreBounds, so that no block of 10 cm and 0.75 deg is missed; the best of each eight that
/// are left is fitted.
class PlaceSearch {
 public:
  PlaceSearch(const OccupancyGrid& occupancy, std::shared_ptr<const WallField> walls,
              const PlaceSearchOptions& options = {});

  FoundPlaces find(const PointSet& points_base_m, Threads threads = {}) const;

 private:
  /// Poses around a place and a heading.
  struct Block {
    float bound = 0.0f;        ///< none of its poses scores more
    std::int32_t place = 0;    ///< index in places_m_
    std::int32_t heading = 0;  ///< in steps of the largest blocks
  };
  struct Leaf {
    double score = 0.0;  ///< at the pose
    Pose2 map_T_base;
  };
  class Descent;

  int headings() const;
  std::vector<Block> bounded_blocks(const PointSet& points, Threads threads) const;
  std::vector<Leaf> leaves(const PointSet& points, std::vector<Block> blocks, double least,
                           Threads threads) const;
  std::vector<WallFit> fitted(const PointSet& points, const std::vector<Leaf>& leaves, double least,
                              Threads threads) const;

  std::shared_ptr<const WallField> walls_;
  PlaceSearchOptions options_;
  ScoreBounds bounds_;
  std::vector<Eigen::Vector2d> places_m_;  ///< middles of the largest blocks that hold ground to stand on
};

}  // namespace mstsl
