#include "tiling.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

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

/// The tiles of one engine over a map.
class Tiles {
 public:
  Tiles(const TileEngine& engine, std::span<const Vector2d> positions_m, const FieldArea& area)
      : engine_(engine),
        area_(area),
        positions_m_(positions_m),
        bins_(positions_m, std::max(0.1, 0.25 * engine.halo_m())) {}

  /// First cells of the tiles in which something is wanted near enough to a fingerprint.
  std::vector<Cell> corners() const {
    std::vector<Cell> corners;
    for (int row = 0; row < area_.geometry.rows; row += engine_.cells())
      for (int column = 0; column < area_.geometry.columns; column += engine_.cells())
        if (needs_data({column, row})) corners.push_back({column, row});
    return corners;
  }

  void fill(Cell corner, const PutCell& put) const {
    const TileField field = engine_.solve(around(corner));
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

  std::vector<NearFingerprint> around(Cell corner) const {
    const double cell_m = area_.geometry.resolution_m, halo_m = engine_.halo_m();
    const Vector2d low_m(corner.column * cell_m, corner.row * cell_m);
    std::vector<NearFingerprint> around;
    for (const std::size_t i :
         bins_.in_box(low_m.array() - halo_m, low_m.array() + engine_.cells() * cell_m + halo_m))
      around.push_back({i, positions_m_[i] - low_m});
    return around;
  }

  const TileEngine& engine_;
  const FieldArea& area_;
  std::span<const Vector2d> positions_m_;
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

void fill_by_tiles(const TileEngine& engine, std::span<const Vector2d> positions_m, const FieldArea& area,
                   const TilingOptions& options, const PutCell& put) {
  const Tiles tiles(engine, positions_m, area);
  const std::vector<Cell> corners = tiles.corners();
  Meter meter(options.progress, corners.size());
  parallel_for(corners.size(), options.threads, [&](std::size_t t) {
    tiles.fill(corners[t], put);
    meter.one_done();
  });
}

}  // namespace mstsl
