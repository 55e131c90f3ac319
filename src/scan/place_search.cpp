#include "mstsl/scan/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace mstsl {
namespace {

/// The slacks for which layers are kept (m); a point uses the next larger one. Halved blocks of the default
/// size need 0.2 m for near points and 0.33 m for those 12 m away, whole ones 0.34 and 0.63 m.
constexpr std::array<double, 6> kSlacks_m{0.22, 0.30, 0.40, 0.48, 0.56, 0.66};

constexpr double kFullScale = 255.0;

std::vector<std::uint8_t> layer_values(const DistanceField& distances, double slack_m, double sigma_m,
                                       int margin) {
  const GridGeometry& g = distances.geometry();
  const std::size_t stride = static_cast<std::size_t>(g.columns + 2 * margin);
  std::vector<std::uint8_t> values(stride * static_cast<std::size_t>(g.rows + 2 * margin), 0);
  const double beyond = distances.max_distance_m() - 1e-6;
  for (int row = 0; row < g.rows; ++row) {
    for (int column = 0; column < g.columns; ++column) {
      const double d = distances.at(Cell{column, row});
      // Out of the field's reach the distance is not known, but it is at least that.
      const double away = std::max(0.0, std::min(d, beyond) - slack_m) / sigma_m;
      values[static_cast<std::size_t>(row + margin) * stride + static_cast<std::size_t>(column + margin)] =
          static_cast<std::uint8_t>(std::ceil(kFullScale * std::exp(-0.5 * away * away)));
    }
  }
  return values;
}

/// Middles of square blocks, in the grid's axes, that hold at least one cell to stand on.
std::vector<Eigen::Vector2d> standable_blocks(const OccupancyGrid& occupancy, const DistanceField& distances,
                                              double block_m, double clearance_m) {
  const GridGeometry& g = occupancy.geometry();
  const int side = std::max(1, static_cast<int>(std::lround(block_m / g.resolution_m)));
  std::vector<Eigen::Vector2d> blocks;
  for (int row = 0; row < g.rows; row += side) {
    for (int column = 0; column < g.columns; column += side) {
      bool standable = false;
      for (int r = row; r < std::min(g.rows, row + side) && !standable; ++r)
        for (int c = column; c < std::min(g.columns, column + side) && !standable; ++c)
          standable = occupancy[{c, r}] == CellState::kFree && distances.at(Cell{c, r}) >= clearance_m;
      if (standable) blocks.push_back(g.to_map({column + 0.5 * side, row + 0.5 * side}));
    }
  }
  return blocks;
}

/// Keeps the best of those that are the same place and heading. Expects the best first.
std::vector<WallFit> distinct(const std::vector<WallFit>& fits, double near_m, double near_rad) {
  using Key = std::tuple<int, int>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return static_cast<std::size_t>(std::get<0>(key)) * 73856093u ^
             static_cast<std::size_t>(std::get<1>(key)) * 19349663u;
    }
  };
  std::unordered_map<Key, std::vector<std::size_t>, Hash> kept_in;
  std::vector<WallFit> kept;
  for (const WallFit& fit : fits) {
    const int x = static_cast<int>(std::floor(fit.map_T_base.x / near_m));
    const int y = static_cast<int>(std::floor(fit.map_T_base.y / near_m));
    bool is_new = true;
    for (int dx = -1; dx <= 1 && is_new; ++dx)
      for (int dy = -1; dy <= 1 && is_new; ++dy)
        if (const auto found = kept_in.find({x + dx, y + dy}); found != kept_in.end())
          is_new = std::ranges::none_of(found->second, [&](std::size_t i) {
            return distance(kept[i].map_T_base, fit.map_T_base) < near_m &&
                   std::abs(angle_between(kept[i].map_T_base.yaw, fit.map_T_base.yaw)) < near_rad;
          });
    if (!is_new) continue;
    kept_in[{x, y}].push_back(kept.size());
    kept.push_back(fit);
  }
  return kept;
}

bool better(const WallFit& a, const WallFit& b) {
  return std::tuple(-a.score, a.map_T_base.x, a.map_T_base.y, a.map_T_base.yaw) <
         std::tuple(-b.score, b.map_T_base.x, b.map_T_base.y, b.map_T_base.yaw);
}

}  // namespace

struct PlaceSearch::Probe {
  struct Point {
    const std::uint8_t* layer = nullptr;  ///< none has slack enough: the point may fit anywhere
    Eigen::Vector2d offset_cells{0, 0};
  };
  std::vector<Point> points;
};

PlaceSearch::PlaceSearch(const OccupancyGrid& occupancy, std::shared_ptr<const WallField> walls,
                         const PlaceSearchOptions& options)
    : walls_(std::move(walls)), options_(options) {
  const GridGeometry& g = walls_->geometry();
  margin_cells_ = static_cast<int>(std::ceil(options_.max_range_m / g.resolution_m)) + 2;
  stride_ = g.columns + 2 * margin_cells_;
  rows_ = g.rows + 2 * margin_cells_;
  for (const double slack_m : kSlacks_m)
    layers_.push_back(
        {slack_m, layer_values(walls_->distances(), slack_m, options_.fit.sigma_m, margin_cells_)});
  blocks_m_ = standable_blocks(occupancy, walls_->distances(), options_.block_m, options_.clearance_m);
}

int PlaceSearch::headings() const {
  return std::max(1, static_cast<int>(std::ceil(2 * kPi / options_.block_rad)));
}

double PlaceSearch::heading_of(const Block& block) const { return block.heading * 2 * kPi / headings(); }

PlaceSearch::Probe PlaceSearch::probe(const PointSet& points, double heading_rad, double side_m,
                                      double turn_rad) const {
  const Eigen::Matrix2d rotation = Pose2{0, 0, heading_rad}.rotation();
  const double resolution_m = walls_->geometry().resolution_m;
  // To a corner of the block, and from the point to the middle of the cell that it is read from.
  const double shift_m = 0.5 * side_m * std::sqrt(2.0) + 0.5 * resolution_m * std::sqrt(2.0);
  Probe probe;
  for (const Eigen::Vector2d& p : points) {
    const double slack_m = shift_m + p.norm() * 0.5 * turn_rad;
    const auto layer = std::ranges::find_if(layers_, [&](const Layer& l) { return l.slack_m >= slack_m; });
    probe.points.push_back({layer == layers_.end() ? nullptr : layer->values.data(),
                            walls_->frame().vector_to_grid(rotation * p)});
  }
  return probe;
}

double PlaceSearch::bound(const Probe& probe, const Eigen::Vector2d& place_m, double least) const {
  constexpr std::size_t kCheckEvery = 16;
  const Eigen::Vector2d at = walls_->frame().to_grid(place_m).array() + margin_cells_;
  const auto count = probe.points.size();
  const double needed = least * kFullScale * static_cast<double>(count);
  int sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [layer, offset_cells] = probe.points[i];
    const int column = static_cast<int>(at.x() + offset_cells.x());
    const int row = static_cast<int>(at.y() + offset_cells.y());
    if (layer == nullptr)
      sum += static_cast<int>(kFullScale);
    else if (column >= 0 && row >= 0 && column < stride_ && row < rows_)
      sum += layer[static_cast<std::size_t>(row) * static_cast<std::size_t>(stride_) +
                   static_cast<std::size_t>(column)];
    if (i % kCheckEvery == kCheckEvery - 1 && sum + kFullScale * static_cast<double>(count - i - 1) < needed)
      return 0;
  }
  return sum / (kFullScale * static_cast<double>(count));
}

std::vector<PlaceSearch::Block> PlaceSearch::surviving_blocks(const PointSet& points, Threads threads) const {
  std::vector<std::vector<Block>> by_heading(static_cast<std::size_t>(headings()));
  parallel_for(by_heading.size(), threads, [&](std::size_t h) {
    const Block block{0, 0, static_cast<std::int32_t>(h)};
    const Probe turned = probe(points, heading_of(block), options_.block_m, 2 * kPi / headings());
    for (std::size_t place = 0; place < blocks_m_.size(); ++place) {
      const double most = bound(turned, blocks_m_[place], options_.min_score);
      if (most < options_.min_score) continue;
      by_heading[h].push_back(
          {static_cast<float>(most), static_cast<std::int32_t>(place), static_cast<std::int32_t>(h)});
    }
  });
  std::vector<Block> blocks;
  for (const auto& some : by_heading) blocks.insert(blocks.end(), some.begin(), some.end());
  std::ranges::sort(blocks, [](const Block& a, const Block& b) {
    return std::tuple(-a.bound, a.place, a.heading) < std::tuple(-b.bound, b.place, b.heading);
  });
  return blocks;
}

std::vector<Pose2> PlaceSearch::halves(const PointSet& points, const Block& block, double least) const {
  const double turn = 2 * kPi / headings(), quarter_m = 0.25 * options_.block_m;
  const Eigen::Vector2d middle = blocks_m_[static_cast<std::size_t>(block.place)];
  std::vector<Pose2> poses;
  for (const double side : {-0.25, 0.25}) {
    const double heading = heading_of(block) + side * turn;
    const Probe turned = probe(points, heading, 0.5 * options_.block_m, 0.5 * turn);
    for (const double dx : {-quarter_m, quarter_m})
      for (const double dy : {-quarter_m, quarter_m}) {
        const Eigen::Vector2d place =
            middle + walls_->geometry().map_T_grid.rotation() * Eigen::Vector2d(dx, dy);
        if (bound(turned, place, least) >= least) poses.push_back(Pose2::from(place, heading));
      }
  }
  return poses;
}

std::vector<WallFit> PlaceSearch::fit_blocks(const PointSet& points, const std::vector<Block>& blocks,
                                             double least, Threads threads) const {
  // The standard deviation of an even spread over half a block.
  const double sigma_m = 0.5 * options_.block_m / std::sqrt(12.0) * 2.0;
  const double sigma_rad = 0.5 * options_.block_rad / std::sqrt(12.0) * 2.0;
  constexpr std::size_t kChunk = 64;
  std::vector<std::vector<WallFit>> by_chunk((blocks.size() + kChunk - 1) / kChunk);
  parallel_for(by_chunk.size(), threads, [&](std::size_t chunk) {
    const std::size_t end = std::min(blocks.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i)
      for (const Pose2& pose : halves(points, blocks[i], least)) {
        const WallFit fit =
            fit_to_walls(*walls_, points, PosePrior::isotropic(pose, sigma_m, sigma_rad), options_.fit);
        if (fit.score >= least) by_chunk[chunk].push_back(fit);
      }
  });
  std::vector<WallFit> fits;
  for (const auto& some : by_chunk) fits.insert(fits.end(), some.begin(), some.end());
  std::ranges::sort(fits, better);
  return fits;
}

FoundPlaces PlaceSearch::find(const PointSet& points_base_m, Threads threads) const {
  PointSet near;
  for (const Eigen::Vector2d& p : points_base_m)
    if (p.norm() <= options_.max_range_m) near.push_back(p);
  const PointSet points = at_most(thinned(near, options_.spacing_m), options_.max_points);
  if (points.size() < options_.min_points) return {{}, true, false};

  FoundPlaces found;
  std::vector<Block> blocks = surviving_blocks(points, threads);
  // The best blocks tell how good the best place is, and so which blocks need not be looked into.
  constexpr std::size_t kFirst = 512;
  const std::vector<Block> first(
      blocks.begin(), blocks.begin() + static_cast<std::ptrdiff_t>(std::min(kFirst, blocks.size())));
  const std::vector<WallFit> best = fit_blocks(points, first, options_.min_score, threads);
  const double least =
      std::max(options_.min_score, best.empty() ? 0.0 : best.front().score - options_.below_best);
  std::erase_if(blocks, [&](const Block& block) { return block.bound < least; });
  if (blocks.size() > options_.max_fits) {
    blocks.resize(options_.max_fits);
    found.complete = false;
  }
  found.fits =
      distinct(fit_blocks(points, blocks, least, threads), options_.distinct_m, options_.distinct_rad);
  if (!found.fits.empty())
    std::erase_if(found.fits, [&](const WallFit& fit) {
      return fit.score < found.fits.front().score - options_.below_best;
    });
  return found;
}

}  // namespace mstsl
