#include "mstsl/scan/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "near_poses.hpp"

namespace mstsl {
namespace {

/// Middles of square blocks, in the grid's axes, that hold at least one cell to stand on.
std::vector<Eigen::Vector2d> standable(const OccupancyGrid& occupancy, const DistanceField& distances,
                                       double block_m, double clearance_m) {
  const GridGeometry& g = occupancy.geometry();
  const int side = std::max(1, static_cast<int>(std::lround(block_m / g.resolution_m)));
  const auto can_stand = [&](int column, int row) {
    return occupancy[{column, row}] == CellState::kFree && distances.at(Cell{column, row}) >= clearance_m;
  };
  std::vector<Eigen::Vector2d> middles;
  for (int row = 0; row < g.rows; row += side) {
    for (int column = 0; column < g.columns; column += side) {
      bool any = false;
      for (int r = row; r < std::min(g.rows, row + side) && !any; ++r)
        for (int c = column; c < std::min(g.columns, column + side) && !any; ++c) any = can_stand(c, r);
      // Blocks at the grid's end reach over it; their middle stays on it.
      if (any)
        middles.push_back(g.to_map(
            {std::min(column + 0.5 * side, g.columns - 0.5), std::min(row + 0.5 * side, g.rows - 0.5)}));
    }
  }
  return middles;
}

bool better(const WallFit& a, const WallFit& b) {
  return std::tuple(-a.score, a.map_T_base.x, a.map_T_base.y, a.map_T_base.yaw) <
         std::tuple(-b.score, b.map_T_base.x, b.map_T_base.y, b.map_T_base.yaw);
}

/// Keeps the best of those that are the same place and heading. Expects the best first.
template <typename Item>
std::vector<Item> distinct(const std::vector<Item>& items, double near_m, double near_rad) {
  NearPoses kept_poses(near_m, near_rad);
  std::vector<Item> kept;
  for (const Item& item : items)
    if (kept_poses.add_if_far(item.map_T_base)) kept.push_back(item);
  return kept;
}

}  // namespace

/// Halves the blocks of one heading twice, keeping what may still score enough.
class PlaceSearch::Descent {
 public:
  Descent(const PlaceSearch& search, const PointSet& points, int heading) : search_(search) {
    const double turn = 2 * kPi / search.headings();
    const double begin = turn * (heading - 0.5), side_m = search.options_.block_m;
    for (int k = 0; k < 2; ++k)
      halves_.push_back(search.bounds_.bound(points, begin + (k + 0.5) * turn / 2, side_m / 2, turn / 2));
    for (int k = 0; k < 4; ++k) {
      headings_rad_.push_back(begin + (k + 0.5) * turn / 4);
      quarters_.push_back(search.bounds_.bound(points, headings_rad_.back(), side_m / 4, turn / 4));
      scores_.push_back(search.bounds_.score(points, headings_rad_.back()));
    }
  }

  /// Appends, for each half of a block that may score `least`, its best quarter's middle.
  void descend(const Eigen::Vector2d& middle_m, double least, std::vector<Leaf>& leaves) const {
    for_quadrants(middle_m, search_.options_.block_m / 4,
                  [&](const Eigen::Vector2d& half_m, std::size_t place) {
                    for (std::size_t half = 0; half < 2; ++half) {
                      if (halves_[half].at(place, least) < least) continue;
                      if (const Leaf best = best_quarter(half_m, half, least); best.score > 0)
                        leaves.push_back(best);
                    }
                  });
  }

 private:
  Leaf best_quarter(const Eigen::Vector2d& middle_m, std::size_t half, double least) const {
    Leaf best;
    for_quadrants(middle_m, search_.options_.block_m / 8,
                  [&](const Eigen::Vector2d& quarter_m, std::size_t place) {
                    for (const std::size_t k : {2 * half, 2 * half + 1}) {
                      if (quarters_[k].at(place, least) < least) continue;
                      if (const double score = scores_[k].at(place, best.score); score > best.score)
                        best = {score, Pose2::from(quarter_m, headings_rad_[k])};
                    }
                  });
    return best;
  }

  /// Calls `use(middle, place)` for the four quadrants of a square whose middles lie `off_m` to each side.
  template <typename Use>
  void for_quadrants(const Eigen::Vector2d& middle_m, double off_m, Use use) const {
    const Eigen::Matrix2d map_R_grid = search_.walls_->geometry().map_T_grid.rotation();
    for (const double dx : {-off_m, off_m}) {
      for (const double dy : {-off_m, off_m}) {
        const Eigen::Vector2d quadrant_m = middle_m + map_R_grid * Eigen::Vector2d(dx, dy);
        if (search_.walls_->geometry().contains(search_.walls_->frame().cell_at(quadrant_m)))
          use(quadrant_m, search_.bounds_.place(quadrant_m));
      }
    }
  }

  const PlaceSearch& search_;
  std::vector<ScoreBounds::Probe> halves_, quarters_, scores_;
  std::vector<double> headings_rad_;  ///< of the quarters
};

PlaceSearch::PlaceSearch(const OccupancyGrid& occupancy, std::shared_ptr<const WallField> walls,
                         const PlaceSearchOptions& options)
    : walls_(std::move(walls)),
      options_(options),
      bounds_(*walls_, options.fit.sigma_m, options.max_range_m),
      places_m_(standable(occupancy, walls_->distances(), options.block_m, options.clearance_m)) {}

int PlaceSearch::headings() const {
  return std::max(1, static_cast<int>(std::ceil(2 * kPi / options_.block_rad)));
}

std::vector<PlaceSearch::Block> PlaceSearch::bounded_blocks(const PointSet& points, Threads threads) const {
  std::vector<std::size_t> places;
  for (const Eigen::Vector2d& place_m : places_m_) places.push_back(bounds_.place(place_m));
  const double turn = 2 * kPi / headings();
  std::vector<std::vector<Block>> by_heading(static_cast<std::size_t>(headings()));
  parallel_for(by_heading.size(), threads, [&](std::size_t h) {
    const ScoreBounds::Probe probe =
        bounds_.bound(points, static_cast<double>(h) * turn, options_.block_m, turn);
    for (std::size_t i = 0; i < places.size(); ++i)
      if (const double bound = probe.at(places[i], options_.min_score); bound >= options_.min_score)
        by_heading[h].push_back(
            {static_cast<float>(bound), static_cast<std::int32_t>(i), static_cast<std::int32_t>(h)});
  });
  std::vector<Block> blocks;
  for (const auto& some : by_heading) blocks.insert(blocks.end(), some.begin(), some.end());
  return blocks;
}

std::vector<PlaceSearch::Leaf> PlaceSearch::leaves(const PointSet& points, std::vector<Block> blocks,
                                                   double least, Threads threads) const {
  std::vector<std::vector<Eigen::Vector2d>> places_by_heading(static_cast<std::size_t>(headings()));
  for (const Block& block : blocks)
    places_by_heading[static_cast<std::size_t>(block.heading)].push_back(
        places_m_[static_cast<std::size_t>(block.place)]);
  std::vector<std::vector<Leaf>> by_heading(places_by_heading.size());
  parallel_for(by_heading.size(), threads, [&](std::size_t h) {
    if (places_by_heading[h].empty()) return;
    const Descent descent(*this, points, static_cast<int>(h));
    for (const Eigen::Vector2d& place_m : places_by_heading[h])
      descent.descend(place_m, least, by_heading[h]);
  });
  std::vector<Leaf> all;
  for (const auto& some : by_heading) all.insert(all.end(), some.begin(), some.end());
  std::ranges::stable_sort(all, [](const Leaf& a, const Leaf& b) { return a.score > b.score; });
  return all;
}

std::vector<WallFit> PlaceSearch::fitted(const PointSet& points, const std::vector<Leaf>& leaves,
                                         double least, Threads threads) const {
  constexpr std::size_t kChunk = 256;
  std::vector<std::vector<WallFit>> by_chunk((leaves.size() + kChunk - 1) / kChunk);
  parallel_for(by_chunk.size(), threads, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(leaves.size(), (chunk + 1) * kChunk); ++i) {
      const PosePrior prior =
          PosePrior::isotropic(leaves[i].map_T_base, 0.25 * options_.block_m, 0.5 * options_.block_rad);
      const WallFit fit = fit_to_walls(*walls_, points, prior, options_.fit);
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

  std::vector<Block> blocks = bounded_blocks(points, threads);
  // The most promising blocks tell how good the best place is, and so which blocks need not be halved.
  constexpr std::size_t kFirst = 1000;
  const auto by_bound = [](const Block& a, const Block& b) {
    return std::tuple(-a.bound, a.place, a.heading) < std::tuple(-b.bound, b.place, b.heading);
  };
  const auto middle = blocks.begin() + static_cast<std::ptrdiff_t>(std::min(kFirst, blocks.size()));
  std::ranges::nth_element(blocks, middle, by_bound);
  std::vector<Leaf> first = leaves(points, {blocks.begin(), middle}, options_.min_score, threads);
  if (first.size() > kFirst) first.resize(kFirst);
  const std::vector<WallFit> best = fitted(points, first, options_.min_score, threads);
  const double least =
      std::max(options_.min_score, best.empty() ? 0.0 : best.front().score - options_.below_best);

  std::erase_if(blocks, [&](const Block& block) { return block.bound < least; });
  std::vector<Leaf> left = leaves(points, std::move(blocks), least, threads);
  std::erase_if(left, [&](const Leaf& leaf) { return leaf.score < least - options_.fit_gains; });
  FoundPlaces found;
  found.complete = left.size() <= options_.max_fits;
  if (!found.complete) left.resize(options_.max_fits);
  found.fits = distinct(fitted(points, left, least, threads), options_.distinct_m, options_.distinct_rad);
  if (!found.fits.empty())
    std::erase_if(found.fits, [cut = found.fits.front().score - options_.below_best](const WallFit& fit) {
      return fit.score < cut;
    });
  return found;
}

}  // namespace mstsl
