#include "mstsl/magnetic/survey_coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

#include "mstsl/core/angles.hpp"
#include "mstsl/grid/distance_field.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/magnetic/survey_bias.hpp"

#include "point_bins.hpp"

namespace mstsl {
namespace {

constexpr double kLeastGap_m2 = 1.0;

bool is_gap(const FieldMap& map, std::size_t i) {
  return map.supported[i] == 0 && map.mean_uT[i].allFinite();
}

/// How far each cell lies inside its gap, in m.
std::vector<float> depths_m(const FieldMap& map) {
  constexpr double kDeep_m = 20.0;
  OccupancyGrid rest(map.geometry, CellState::kFree);
  for (std::size_t i = 0; i < map.geometry.size(); ++i)
    if (!is_gap(map, i)) rest[map.geometry.cell(i)] = CellState::kOccupied;
  return DistanceField(rest, kDeep_m).values_m().values();
}

/// The piece that a cell belongs to: its cells, which are then `seen`.
std::vector<std::size_t> piece_around(const FieldMap& map, std::size_t start,
                                      std::vector<std::uint8_t>& seen) {
  constexpr std::array<std::pair<int, int>, 4> kNeighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  std::vector<std::size_t> piece{start};
  seen[start] = 1;
  for (std::size_t next = 0; next < piece.size(); ++next) {
    const Cell cell = map.geometry.cell(piece[next]);
    for (const auto& [columns, rows] : kNeighbours) {
      const Cell beside{cell.column + columns, cell.row + rows};
      if (!map.geometry.contains(beside)) continue;
      const std::size_t i = map.geometry.index(beside);
      if (seen[i] != 0 || !is_gap(map, i)) continue;
      seen[i] = 1;
      piece.push_back(i);
    }
  }
  return piece;
}

std::vector<CoverageGap> find_gaps(const FieldMap& map) {
  const double cell_m2 = map.geometry.resolution_m * map.geometry.resolution_m;
  const std::vector<float> depth_m = depths_m(map);
  std::vector<std::uint8_t> seen(map.geometry.size(), 0);
  std::vector<CoverageGap> gaps;
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    if (seen[i] != 0 || !is_gap(map, i)) continue;
    const std::vector<std::size_t> piece = piece_around(map, i, seen);
    const double area_m2 = cell_m2 * static_cast<double>(piece.size());
    if (area_m2 < kLeastGap_m2) continue;
    const std::size_t deepest =
        *std::ranges::max_element(piece, {}, [&](std::size_t c) { return depth_m[c]; });
    gaps.push_back({map.geometry.center_of(map.geometry.cell(deepest)), area_m2});
  }
  std::ranges::stable_sort(gaps, std::ranges::greater{}, &CoverageGap::area_m2);
  return gaps;
}

double one_way_share(const std::vector<Fingerprint>& fingerprints) {
  const double near_m = SurveyBiasOptions{}.pair_distance_m;
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(near_m);
  std::vector<Eigen::Vector2d> positions_m;
  for (const Fingerprint& f : fingerprints) positions_m.push_back(f.position_m);
  const PointBins bins(positions_m, near_m);
  std::size_t one_way = 0;
  for (const Fingerprint& f : fingerprints) {
    bool other_way = false;
    bins.for_each_near(f.position_m - reach, f.position_m + reach, [&](std::size_t i) {
      other_way =
          other_way || ((positions_m[i] - f.position_m).norm() <= near_m &&
                        std::abs(angle_between(f.heading_rad, fingerprints[i].heading_rad)) > kPi / 2);
    });
    one_way += other_way ? 0 : 1;
  }
  return fingerprints.empty() ? 0.0 : static_cast<double>(one_way) / static_cast<double>(fingerprints.size());
}

}  // namespace

SurveyCoverage survey_coverage(const FieldMap& map) {
  const double cell_m2 = map.geometry.resolution_m * map.geometry.resolution_m;
  SurveyCoverage coverage;
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    if (map.mean_uT[i].allFinite()) coverage.ground_m2 += cell_m2;
    if (map.supported[i] != 0) coverage.covered_m2 += cell_m2;
  }
  coverage.gaps = find_gaps(map);
  coverage.one_way_share = one_way_share(map.fingerprints);
  return coverage;
}

}  // namespace mstsl
