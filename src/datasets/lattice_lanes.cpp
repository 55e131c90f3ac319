#include "mstsl/datasets/lattice_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace mstsl::datasets {
namespace {

void add_lanes(std::vector<Fingerprint> points, int along, const LatticeOptions& options,
               std::vector<std::vector<Fingerprint>>& lanes) {
  const int across = 1 - along;
  const auto line_of = [&](const Fingerprint& p) {
    return std::llround(p.position_m[across] / options.same_line_m);
  };
  std::stable_sort(points.begin(), points.end(), [&](const Fingerprint& a, const Fingerprint& b) {
    return std::pair(line_of(a), a.position_m[along]) < std::pair(line_of(b), b.position_m[along]);
  });
  std::vector<Fingerprint> lane;
  const auto close = [&] {
    if (lane.size() >= options.fewest_points) lanes.push_back(lane);
    lane.clear();
  };
  for (const Fingerprint& point : points) {
    const bool follows = !lane.empty() && line_of(point) == line_of(lane.back()) &&
                         point.position_m[along] - lane.back().position_m[along] <= options.longest_gap_m;
    if (!follows) close();
    lane.push_back(point);
  }
  close();
}

}  // namespace

std::vector<std::vector<Fingerprint>> lattice_lanes(std::span<const Fingerprint> points,
                                                    const LatticeOptions& options) {
  std::vector<std::vector<Fingerprint>> lanes;
  for (const int along : {0, 1}) add_lanes({points.begin(), points.end()}, along, options, lanes);
  return lanes;
}

}  // namespace mstsl::datasets
