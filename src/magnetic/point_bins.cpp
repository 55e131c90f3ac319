#include "point_bins.hpp"

#include <algorithm>
#include <cmath>

namespace mstsl {

PointBins::PointBins(std::span<const Eigen::Vector2d> points_m, double side_m)
    : points_(points_m), side_m_(side_m) {
  entries_.reserve(points_m.size());
  for (std::size_t i = 0; i < points_m.size(); ++i) entries_.push_back({bin_of(points_m[i]), i});
  std::sort(entries_.begin(), entries_.end());
}

PointBins::Bin PointBins::bin_of(const Eigen::Vector2d& point_m) const {
  constexpr double kFar = 1e15;  // any coordinate converts safely
  const auto index = [&](double x) {
    return static_cast<std::int64_t>(std::clamp(std::floor(x / side_m_), -kFar, kFar));
  };
  return {index(point_m.y()), index(point_m.x())};
}

std::size_t PointBins::first_at_or_after(const Bin& bin) const {
  const auto before = [](const Entry& entry, const Bin& b) { return entry.bin < b; };
  return static_cast<std::size_t>(std::lower_bound(entries_.begin(), entries_.end(), bin, before) -
                                  entries_.begin());
}

std::vector<std::size_t> PointBins::in_box(const Eigen::Vector2d& low_m,
                                           const Eigen::Vector2d& high_m) const {
  std::vector<std::size_t> found;
  for_each_near(low_m, high_m, [&](std::size_t i) {
    const Eigen::Array2d p = points_[i].array();
    if ((p >= low_m.array()).all() && (p <= high_m.array()).all()) found.push_back(i);
  });
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::vector<std::size_t>> PointBins::occupied() const {
  std::vector<std::vector<std::size_t>> bins;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (i == 0 || entries_[i].bin != entries_[i - 1].bin) bins.emplace_back();
    bins.back().push_back(entries_[i].index);
  }
  return bins;
}

}  // namespace mstsl
