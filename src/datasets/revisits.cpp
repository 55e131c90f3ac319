#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mstsl/datasets/carmen.hpp"
#include "mstsl/datasets/windows.hpp"
#include "mstsl/grid/distance_field.hpp"
#include "mstsl/sim/segment_index.hpp"

namespace mstsl::datasets {
namespace {

std::vector<Eigen::Vector2d> positions(std::span<const PoseReading> poses) {
  std::vector<Eigen::Vector2d> path_m;
  for (const PoseReading& pose : poses) path_m.push_back(pose.map_T_base.position());
  return path_m;
}

}  // namespace

std::size_t first_scan_after(std::span<const PoseReading> corrected, double share) {
  const std::vector<double> along_m = distances_along(positions(corrected));
  return static_cast<std::size_t>(std::upper_bound(along_m.begin(), along_m.end(), share * along_m.back()) -
                                  along_m.begin());
}

Revisits find_revisits(std::span<const PoseReading> corrected, const OccupancyGrid& first_map,
                       const CarmenOptions& options) {
  const std::vector<Eigen::Vector2d> path_m = positions(corrected);
  const std::vector<double> along_m = distances_along(path_m);
  Revisits revisits;
  const std::size_t split = first_scan_after(corrected, options.mapped_share);
  revisits.first_later_scan = split;
  revisits.first_m = along_m[split - 1];
  revisits.later_m = along_m.back() - revisits.first_m;

  constexpr double kNear_m = 1.0;
  const sim::SegmentIndex first_way(
      sim::polyline({path_m.begin(), path_m.begin() + static_cast<std::ptrdiff_t>(split)}, false));
  const DistanceField clearance(first_map,
                                std::max(2.0 * options.clearance_m, first_map.geometry().resolution_m));
  std::size_t near = 0;
  bool before = false;
  revisits.follows.assign(path_m.size(), false);
  for (std::size_t i = split; i < path_m.size(); ++i) {
    const double away_m = first_way.clearance(path_m[i], std::max(2.0 * kNear_m, 2.0 * options.near_m));
    if (away_m < kNear_m) ++near;
    const bool now = away_m <= options.near_m && state_at(first_map, path_m[i]) == CellState::kFree &&
                     clearance.at(path_m[i]) >= options.clearance_m;
    if (now) ++revisits.revisiting;
    revisits.follows[i] = now && before;
    before = now;
  }
  const std::size_t later = path_m.size() - split;
  revisits.within_1m_share = later == 0 ? 0.0 : static_cast<double>(near) / static_cast<double>(later);
  return revisits;
}

}  // namespace mstsl::datasets
