#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace mstsl {

/// Points sorted into square bins, to find those in a box quickly. Answers come in one fixed order: by bin
/// row, bin column, then index. Memory grows with the points, not with the area they span.
class PointBins {
 public:
  PointBins(std::span<const Eigen::Vector2d> points_m, double side_m);

  /// Calls `visit(index)` for every point in the bins that touch the box (so also for some outside it).
  template <typename Visit>
  void for_each_near(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, const Visit& visit) const {
    const Bin low = bin_of(low_m), high = bin_of(high_m);
    for (std::int64_t row = low.row; row <= high.row; ++row)
      for (std::size_t i = first_at_or_after({row, low.column}); i < entries_.size(); ++i) {
        if (entries_[i].bin.row != row || entries_[i].bin.column > high.column) break;
        visit(entries_[i].index);
      }
  }

  /// Indices of the points within the box, in increasing order.
  std::vector<std::size_t> in_box(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m) const;

  /// Index ranges of the occupied bins, in order of row and column.
  std::vector<std::vector<std::size_t>> occupied() const;

 private:
  struct Bin {
    std::int64_t row, column;
    friend auto operator<=>(const Bin&, const Bin&) = default;
  };
  struct Entry {
    Bin bin;
    std::size_t index;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };
  Bin bin_of(const Eigen::Vector2d& point_m) const;
  std::size_t first_at_or_after(const Bin& bin) const;

  std::span<const Eigen::Vector2d> points_;
  double side_m_;
  std::vector<Entry> entries_;
};

}  // namespace mstsl
