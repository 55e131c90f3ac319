#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/fit_to_walls.hpp"
#include "mstsl/scan/points.hpp"
#include "mstsl/scan/wall_field.hpp"

namespace mstsl {

struct PlaceSearchOptions {
  /// Blocks of poses are this large: side in m, and headings in rad. Each is halved once.
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
  /// Answers closer together than this in both place and heading are one.
  double distinct_m = 0.2;
  double distinct_rad = radians(3.0);
  /// No more fits than this are made, those with the highest bounds first, and a note is made if it was not
  /// enough.
  std::size_t max_fits = 40'000;
  FitOptions fit = {};
};

/// Where a scan may have been taken, over the whole free space and all headings.
struct FoundPlaces {
  std::vector<WallFit> fits;  ///< best first
  bool complete = true;       ///< false: max_fits cut it short
  bool informative = true;    ///< false: too few points to search with; `fits` is empty
};

/// Lists all poses at which a scan fits nearly as well as at the best, however many there are: a corridor
/// gives hundreds. Nothing is missed, by bounds as in branch and bound (Hess et al. 2016): distances to walls
/// change no faster than a point moves, so a block of poses that moves a point by at most delta scores at
/// most exp(-max(0, d - delta)^2 / (2 sigma^2)) there.
class PlaceSearch {
 public:
  PlaceSearch(const OccupancyGrid& occupancy, std::shared_ptr<const WallField> walls,
              const PlaceSearchOptions& options = {});

  FoundPlaces find(const PointSet& points_base_m, Threads threads = {}) const;

  /// All the blocks' middles that a robot can stand on: what is left to believe where a scan tells nothing.
  const std::vector<Eigen::Vector2d>& blocks_m() const { return blocks_m_; }

 private:
  struct Block {
    float bound = 0.0f;
    std::int32_t place = 0;    ///< index in blocks_m_
    std::int32_t heading = 0;  ///< in steps of block_rad
  };
  /// Bounds for poses that move a point by at most `slack_m`, one byte a cell, with a margin of zeros around.
  struct Layer {
    double slack_m = 0.0;
    std::vector<std::uint8_t> values;
  };
  struct Probe;  ///< points turned to one heading, as offsets into the layers

  Probe probe(const PointSet& points, double heading_rad, double side_m, double turn_rad) const;
  double bound(const Probe& probe, const Eigen::Vector2d& place_m, double least) const;
  std::vector<Block> surviving_blocks(const PointSet& points, Threads threads) const;
  std::vector<WallFit> fit_blocks(const PointSet& points, const std::vector<Block>& blocks, double least,
                                  Threads threads) const;
  std::vector<Pose2> halves(const PointSet& points, const Block& block, double least) const;
  int headings() const;
  double heading_of(const Block& block) const;

  std::shared_ptr<const WallField> walls_;
  PlaceSearchOptions options_;
  int margin_cells_ = 0;
  int stride_ = 0;
  int rows_ = 0;
  std::vector<Layer> layers_;
  std::vector<Eigen::Vector2d> blocks_m_;
};

}  // namespace mstsl
