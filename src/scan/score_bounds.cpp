#include "mstsl/scan/score_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mstsl {
namespace {

/// A point uses the least of these (m) that is enough for it. Blocks of 0.1 m need 0.11 to 0.19 m for points
/// up to 12 m away, of 0.2 m 0.18 to 0.34 m, of 0.4 m 0.32 to 0.64 m. With the last a point fits anywhere.
constexpr std::array kSlacks_m{0.0, 0.12, 0.15, 0.19, 0.25, 0.33, 0.40, 0.50, 0.65, 1e9};

constexpr double kFullScale = 255.0;

/// What a point at such a distance from a wall scores at most, when it may move by the slack; rounded up.
std::uint8_t at_most(double distance_m, double slack_m, double sigma_m) {
  const double away = std::max(0.0, distance_m - slack_m) / sigma_m;
  return static_cast<std::uint8_t>(std::ceil(kFullScale * std::exp(-0.5 * away * away)));
}

/// The same for all distances that two cells can have: by their square, in cells.
std::vector<std::uint8_t> by_squared_cells(const DistanceField& distances, double slack_m, double sigma_m) {
  const double cell_m = distances.geometry().resolution_m, farthest_m = distances.max_distance_m();
  std::vector<std::uint8_t> table;
  for (int squared = 0; table.empty() || std::sqrt(squared - 1) * cell_m < farthest_m; ++squared)
    table.push_back(at_most(std::min(farthest_m, std::sqrt(squared) * cell_m), slack_m, sigma_m));
  return table;
}

}  // namespace

ScoreBounds::ScoreBounds(const WallField& walls, double sigma_m, double reach_m)
    : frame_(walls.geometry()),
      margin_(static_cast<int>(std::ceil(reach_m / walls.geometry().resolution_m)) + 2),
      stride_(static_cast<std::size_t>(walls.geometry().columns + 2 * margin_)) {
  const GridGeometry& g = walls.geometry();
  const std::size_t size = stride_ * static_cast<std::size_t>(g.rows + 2 * margin_);
  std::vector<std::vector<std::uint8_t>> tables;
  for (const double slack_m : kSlacks_m) {
    const bool anything = slack_m >= walls.reach_m();
    layers_.push_back({slack_m, std::vector<std::uint8_t>(size, anything ? 255 : 0)});
    if (!anything) tables.push_back(by_squared_cells(walls.distances(), slack_m, sigma_m));
  }
  const std::vector<float>& distances_m = walls.distances().values_m().values();
  for (int row = 0; row < g.rows; ++row) {
    const std::size_t from = g.index({0, row}), to = static_cast<std::size_t>(row + margin_) * stride_ +
                                                     static_cast<std::size_t>(margin_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(g.columns); ++i) {
      const double cells = distances_m[from + i] / g.resolution_m;
      const auto squared = static_cast<std::size_t>(std::lround(cells * cells));
      for (std::size_t k = 0; k < tables.size(); ++k)
        layers_[k].values[to + i] = tables[k][std::min(squared, tables[k].size() - 1)];
    }
  }
}

std::size_t ScoreBounds::place(const Eigen::Vector2d& map_point_m) const {
  const Cell cell = frame_.cell_at(map_point_m);
  return static_cast<std::size_t>(cell.row + margin_) * stride_ +
         static_cast<std::size_t>(cell.column + margin_);
}

ScoreBounds::Probe ScoreBounds::score(const PointSet& points_base_m, double heading_rad) const {
  return probe(points_base_m, heading_rad, [](double) { return 0.0; });
}

ScoreBounds::Probe ScoreBounds::bound(const PointSet& points_base_m, double heading_rad, double side_m,
                                      double headings_rad) const {
  // From the block's middle to its corner; and the place and the point are rounded to cells, each by up to
  // half a cell's diagonal.
  const double shift_m = 0.5 * std::sqrt(2.0) * (side_m + 2 * frame_.geometry().resolution_m);
  return probe(points_base_m, heading_rad,
               [=](double range_m) { return shift_m + 0.5 * headings_rad * range_m; });
}

template <typename Slack>
ScoreBounds::Probe ScoreBounds::probe(const PointSet& points_base_m, double heading_rad, Slack slack) const {
  const Eigen::Matrix2d rotation = Pose2{0, 0, heading_rad}.rotation();
  Probe probe;
  for (const Eigen::Vector2d& p : points_base_m) {
    const double slack_m = slack(p.norm());
    const auto fitting = std::ranges::find_if(layers_, [&](const Layer& l) { return l.slack_m >= slack_m; });
    const Eigen::Vector2d cells = frame_.vector_to_grid(rotation * p);
    const std::ptrdiff_t offset =
        std::lround(cells.y()) * static_cast<std::ptrdiff_t>(stride_) + std::lround(cells.x());
    probe.points_.push_back((fitting == layers_.end() ? layers_.back() : *fitting).values.data() + offset);
  }
  return probe;
}

double ScoreBounds::Probe::at(std::size_t place, double least) const {
  constexpr std::size_t kCheckEvery = 12;
  const std::size_t count = points_.size();
  const double full = kFullScale * static_cast<double>(count);
  int sum = 0;
  for (std::size_t i = 0; i < count;) {
    for (const std::size_t end = std::min(count, i + kCheckEvery); i < end; ++i) sum += points_[i][place];
    if (sum + kFullScale * static_cast<double>(count - i) < least * full) return 0.0;
  }
  return sum / full;
}

}  // namespace mstsl
