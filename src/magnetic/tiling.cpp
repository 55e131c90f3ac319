#include "tiling.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <utility>

#include "contaminated_noise.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;

/// Tells the share of the work done, from one thread at a time.
class Meter {
 public:
  Meter(const std::function<void(double)>& progress, std::size_t total)
      : progress_(progress), total_(static_cast<double>(total)) {}
  void one_done() {
    const std::size_t done = ++done_;
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    progress_(static_cast<double>(done) / total_);
  }

 private:
  const std::function<void(double)>& progress_;
  double total_;
  std::atomic<std::size_t> done_ = 0;
  std::mutex mutex_;
};

/// The tiles of one engine over a map, and what they make of the fingerprints.
class Tiles {
 public:
  Tiles(const TileEngine& engine, std::span<const Fingerprint> fingerprints,
        std::span<const Vector2d> positions_m, const FieldArea& area)
      : engine_(engine),
        fingerprints_(fingerprints),
        positions_m_(positions_m),
        area_(area),
        bins_(positions_m, std::max(0.1, 0.25 * engine.halo_m())) {}

  /// First cells of the tiles in which something is wanted near enough to a fingerprint.
  std::vector<Cell> corners() const {
    std::vector<Cell> corners;
    for (int row = 0; row < area_.geometry.rows; row += engine_.cells())
      for (int column = 0; column < area_.geometry.columns; column += engine_.cells())
        if (needs_data({column, row})) corners.push_back({column, row});
    return corners;
  }

  /// Solves a tile and gives the fingerprints in it their new weights.
  void solve(Cell corner, std::span<const double> weights, std::vector<double>& new_weights,
             const PutCell& put) const {
    const std::vector<NearFingerprint> near = around(corner, weights);
    const TileField field = engine_.solve(near);
    for (int row = 0; row < engine_.cells(); ++row)
      for (int column = 0; column < engine_.cells(); ++column) {
        const Cell cell{corner.column + column, corner.row + row};
        if (!near_data(cell)) continue;
        for (const int c : engine_.components()) {
          const auto k = static_cast<std::size_t>(c);
          put(area_.geometry.index(cell), c, field.mean_uT[k](column, row),
              field.variance_uT2[k](column, row));
        }
      }
    const double side_m = engine_.cells() * area_.geometry.resolution_m;
    for (std::size_t i = 0; i < near.size(); ++i) {
      const Eigen::Array2d p = near[i].position_m.array();
      if (!(p >= 0.0).all() || !(p < side_m).all()) continue;
      const Eigen::Vector3d mean_uT = field.mean_at_fingerprints_uT.row(static_cast<Eigen::Index>(i));
      new_weights[near[i].index] = weight_of(fingerprints_[near[i].index].field_uT - mean_uT);
    }
  }

  /// Whether one of the fingerprints marked is in or around a tile.
  bool has_near(Cell corner, const std::vector<std::uint8_t>& marked) const {
    const auto [low_m, high_m] = box(corner);
    bool found = false;
    bins_.for_each_near(low_m, high_m, [&](std::size_t i) { found = found || marked[i] != 0; });
    return found;
  }

 private:
  bool near_data(Cell cell) const {
    if (!area_.geometry.contains(cell)) return false;
    const std::size_t i = area_.geometry.index(cell);
    return area_.wanted[i] != 0 && static_cast<double>(area_.distance_m[i]) < engine_.near_m();
  }

  bool needs_data(Cell corner) const {
    for (int row = corner.row; row < corner.row + engine_.cells(); ++row)
      for (int column = corner.column; column < corner.column + engine_.cells(); ++column)
        if (near_data({column, row})) return true;
    return false;
  }

  Vector2d low_corner_m(Cell corner) const {
    return area_.geometry.resolution_m * Vector2d(corner.column, corner.row);
  }

  /// The tile and its halo.
  std::pair<Vector2d, Vector2d> box(Cell corner) const {
    const double halo_m = engine_.halo_m(), side_m = engine_.cells() * area_.geometry.resolution_m;
    const Vector2d low_m = low_corner_m(corner);
    return {low_m.array() - halo_m, low_m.array() + side_m + halo_m};
  }

  std::vector<NearFingerprint> around(Cell corner, std::span<const double> weights) const {
    const auto [low_m, high_m] = box(corner);
    std::vector<NearFingerprint> around;
    for (const std::size_t i : bins_.in_box(low_m, high_m))
      around.push_back({i, weights[i], positions_m_[i] - low_corner_m(corner)});
    return around;
  }

  double weight_of(const Eigen::Vector3d& deviation_uT) const {
    double squared = 0.0;
    for (const int c : engine_.components())
      squared += std::pow(deviation_uT(c) / engine_.noise_sd_uT()(c), 2);
    return noise_weight(squared, static_cast<int>(engine_.components().size()));
  }

  const TileEngine& engine_;
  std::span<const Fingerprint> fingerprints_;
  std::span<const Vector2d> positions_m_;
  const FieldArea& area_;
  PointBins bins_;
};

}  // namespace

std::vector<Vector2d> in_grid_frame(std::span<const Fingerprint> fingerprints, const GridGeometry& geometry) {
  std::vector<Vector2d> positions_m;
  for (const Fingerprint& f : fingerprints)
    positions_m.push_back(geometry.to_grid(f.position_m) * geometry.resolution_m);
  return positions_m;
}

double dense_samples_per_m2(std::span<const Vector2d> positions_m, double side_m) {
  std::vector<std::size_t> counts;
  for (const auto& bin : PointBins(positions_m, side_m).occupied()) counts.push_back(bin.size());
  const auto high = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() * 95 / 100);
  std::nth_element(counts.begin(), high, counts.end());
  return static_cast<double>(*high) / (side_m * side_m);
}

std::vector<double> fill_by_tiles(const TileEngine& engine, std::span<const Fingerprint> fingerprints,
                                  std::span<const Vector2d> positions_m, const FieldArea& area,
                                  const TilingOptions& options, const PutCell& put) {
  constexpr int kMostRounds = 5;
  constexpr double kStands = 0.25;  // a smaller change of a weight changes no map
  const Tiles tiles(engine, fingerprints, positions_m, area);
  std::vector<Cell> corners = tiles.corners();
  std::vector<double> weights(fingerprints.size(), 1.0);
  Meter meter(options.progress, corners.size());
  for (int round = 0; round < kMostRounds && !corners.empty(); ++round) {
    std::vector<double> new_weights = weights;
    parallel_for(corners.size(), options.threads, [&](std::size_t t) {
      tiles.solve(corners[t], weights, new_weights, put);
      if (round == 0) meter.one_done();
    });
    if (!options.heavy_tails) break;
    std::vector<std::uint8_t> changed(weights.size(), 0);
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (std::abs(new_weights[i] - weights[i]) > kStands) {
        changed[i] = 1;
        weights[i] = new_weights[i];
      }
    std::erase_if(corners, [&](Cell corner) { return !tiles.has_near(corner, changed); });
  }
  return weights;
}

}  // namespace mstsl
