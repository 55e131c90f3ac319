#pragma once

#include <cassert>
#include <utility>
#include <vector>

#include "mstsl/grid/geometry.hpp"

namespace mstsl {

/// One value a cell.
template <typename T>
class Grid {
 public:
  Grid() = default;
  explicit Grid(const GridGeometry& geometry, const T& value = T{})
      : geometry_(geometry), values_(geometry.size(), value) {}
  Grid(const GridGeometry& geometry, std::vector<T> values)
      : geometry_(geometry), values_(std::move(values)) {
    assert(values_.size() == geometry_.size());
  }

  const GridGeometry& geometry() const { return geometry_; }
  const std::vector<T>& values() const { return values_; }
  std::vector<T>& values() { return values_; }

  bool contains(Cell cell) const { return geometry_.contains(cell); }
  const T& operator[](Cell cell) const { return assert(contains(cell)), values_[geometry_.index(cell)]; }
  T& operator[](Cell cell) { return assert(contains(cell)), values_[geometry_.index(cell)]; }

 private:
  GridGeometry geometry_;
  std::vector<T> values_;
};

}  // namespace mstsl
