#pragma once

#include <cstdint>
#include <vector>

#include "mstsl/core/pose2.hpp"
#include "mstsl/grid/grid.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

/// What one scan says of a cell, in log odds.
struct BeamModel {
  /// A beam ends in the cell: probability 0.7.
  double hit_log_odds = 0.85;
  /// Beams only pass through: probability 0.4. A wall must be seen through twice as often as hit to vanish.
  /// (Both from Thrun, Burgard & Fox, Probabilistic Robotics, Sec. 9.2, where a hit counts for more than a
  /// miss.)
  double miss_log_odds = -0.4;
  /// Belief stops at plus and minus this, so that a map can still change its mind.
  double limit_log_odds = 6.0;
  /// A return from farther away is not drawn, only the free way towards it up to here (m).
  double max_range_m = 30.0;
};

/// A map being drawn: what is believed of each cell, in log odds (0: nothing known), from beams with known
/// poses.
class LogOddsGrid {
 public:
  explicit LogOddsGrid(const GridGeometry& geometry, const BeamModel& model = {});

  const GridGeometry& geometry() const { return values_.geometry(); }
  const Grid<float>& values() const { return values_; }

  /// Draws one scan taken at `map_T_base`. A scan counts once in a cell, as a hit if any of its beams ends
  /// there: so beams that graze a wall do not rub it out. What lies outside the grid is left out.
  void draw(const std::vector<BeamReturn>& returns_base, const Pose2& map_T_base);

  /// The same map on another grid that lies in whole cells from this one: what both share is kept.
  LogOddsGrid moved_to(const GridGeometry& geometry) const;

  /// Occupied above, free below the given probabilities, unknown between.
  OccupancyGrid occupancy(double occupied_probability, double free_probability) const;

 private:
  void add(Cell cell, double log_odds);

  BeamModel model_;
  Grid<float> values_;
  Grid<std::uint32_t> drawn_in_;  ///< the last scan that changed the cell, so that each does so once
  std::uint32_t scan_ = 0;
};

}  // namespace mstsl
