#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mstsl/grid/geometry.hpp"
#include "mstsl/scan/likelihood_field.hpp"

namespace mstsl {

/// The likelihood field in 8 bits and, for each level h, the maximum over the 2^h x 2^h cells that begin at
/// each cell (Hess et al. 2016, Eq. 16): upper bounds on what any shift within such a block can score.
class LikelihoodPyramid {
 public:
  /// `levels` > 0 counts the finest one; a level more takes once more the field's memory (1 byte a cell).
  explicit LikelihoodPyramid(const LikelihoodField& field, int levels = 7);

  const GridGeometry& geometry() const { return geometry_; }
  int levels() const { return static_cast<int>(levels_.size()); }

  /// A cell on a wall has this value, a cell three sigma from any 0.
  static constexpr int kFullScale = 255;

  /// The largest value over the cells from `cell` to `cell` + (2^level - 1); 0 where all lie
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
  Level coarser(int level) const;

  GridGeometry geometry_;
  std::vector<Level> levels_;
};

}  // namespace mstsl
