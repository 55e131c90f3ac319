#include "mstsl/scan/likelihood_pyramid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace mstsl {

LikelihoodPyramid::LikelihoodPyramid(const LikelihoodField& field, int levels) : geometry_(field.geometry()) {
  assert(levels > 0);
  Level finest{.margin = 0, .columns = geometry_.columns, .rows = geometry_.rows, .values = {}};
  finest.values.reserve(geometry_.size());
  for (const float likelihood : field.values().values()) {
    finest.values.push_back(
        static_cast<std::uint8_t>(std::lround(kFullScale * std::clamp(likelihood, 0.0F, 1.0F))));
  }
  levels_.push_back(std::move(finest));
  while (this->levels() < levels) levels_.push_back(coarser(this->levels() - 1));
}

LikelihoodPyramid::Level LikelihoodPyramid::coarser(int level) const {
  const int half = 1 << level;  // the window's side on the finer level; four of them make one of the coarser
  Level coarse;
  coarse.margin = 2 * half - 1;
  coarse.columns = geometry_.columns == 0 ? 0 : geometry_.columns + coarse.margin;
  coarse.rows = geometry_.rows == 0 ? 0 : geometry_.rows + coarse.margin;
  coarse.values.reserve(static_cast<std::size_t>(coarse.columns) * static_cast<std::size_t>(coarse.rows));
  for (int row = -coarse.margin; row < geometry_.rows; ++row) {
    for (int column = -coarse.margin; column < geometry_.columns; ++column) {
      coarse.values.push_back(static_cast<std::uint8_t>(
          std::max(std::max(at(level, {column, row}), at(level, {column + half, row})),
                   std::max(at(level, {column, row + half}), at(level, {column + half, row + half})))));
    }
  }
  return coarse;
}

}  // namespace mstsl
