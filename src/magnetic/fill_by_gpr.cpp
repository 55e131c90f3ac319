#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

#include "field_models.hpp"
#include "point_bins.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;

/// Fingerprints per square metre where they are dense: the 95th percentile over squares of a length scale.
double dense_samples_per_m2(std::span<const Vector2d> positions_m, double length_scale_m) {
  std::vector<std::size_t> counts;
  for (const auto& bin : PointBins(positions_m, length_scale_m).occupied()) counts.push_back(bin.size());
  const auto high = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() * 95 / 100);
  std::nth_element(counts.begin(), high, counts.end());
  return static_cast<double>(*high) / (length_scale_m * length_scale_m);
}

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

/// Square tiles over the cells of a map, and the regression of the components that share one covariance.
class TiledRegression {
 public:
  TiledRegression(const SurveyAnalysis& survey, const FieldArea& area, const FillOptions& options,
                  std::vector<int> components)
      : survey_(survey),
        area_(area),
        components_(std::move(components)),
        positions_m_(in_grid_frame(survey.fingerprints, area.geometry)),
        bins_(positions_m_, std::max(0.1, length_scale_m())),
        tile_(tile_options(options)) {}

  /// First cells of the tiles in which something is wanted near enough to a fingerprint.
  std::vector<Cell> tiles() const {
    std::vector<Cell> tiles;
    for (int row = 0; row < area_.geometry.rows; row += tile_.cells())
      for (int column = 0; column < area_.geometry.columns; column += tile_.cells())
        if (needs_data({column, row})) tiles.push_back({column, row});
    return tiles;
  }

  void fill(Cell corner, TileRegression::Workspace& workspace, FieldMap& map) const {
    const auto posterior = tile_.solve(samples_around(corner), workspace);
    for (int row = 0; row < tile_.cells(); ++row)
      for (int column = 0; column < tile_.cells(); ++column) {
        const Cell cell{corner.column + column, corner.row + row};
        if (!near_data(cell)) continue;
        for (const int c : components_) {
          const double mean = posterior.mean[static_cast<std::size_t>(c)](column, row);
          put(map, area_.geometry.index(cell), c, mean, posterior.variance(column, row));
        }
      }
  }

  /// What cells far from all data hold: the prior.
  void fill_prior(FieldMap& map) const {
    for (std::size_t i = 0; i < area_.wanted.size(); ++i)
      if (area_.wanted[i] != 0)
        for (const int c : components_) put(map, i, c, 0.0, 1.0);
  }

 private:
  double length_scale_m() const { return h().length_scale_m(components_.front()); }
  const FieldHyperparameters& h() const { return survey_.hyperparameters.values; }

  TileOptions tile_options(const FillOptions& options) const {
    const int c = components_.front();
    TileOptions tile;
    tile.length_scale_m = h().length_scale_m(c);
    tile.noise_ratio = std::max(h().noise_sd_uT(c) / h().signal_sd_uT(c), TileRegression::kMinNoiseRatio);
    tile.cell_m = area_.geometry.resolution_m;
    tile.samples_per_m2 = dense_samples_per_m2(positions_m_, tile.length_scale_m);
    tile.quality = options.quality;
    return tile;
  }

  static std::vector<Vector2d> in_grid_frame(std::span<const Fingerprint> fingerprints,
                                             const GridGeometry& geometry) {
    std::vector<Vector2d> positions;
    for (const Fingerprint& f : fingerprints)
      positions.push_back(geometry.to_grid(f.position_m) * geometry.resolution_m);
    return positions;
  }

  bool near_data(Cell cell) const {
    if (!area_.geometry.contains(cell)) return false;
    const std::size_t i = area_.geometry.index(cell);
    return area_.wanted[i] != 0 && static_cast<double>(area_.distance_m[i]) < kPriorBeyond * length_scale_m();
  }

  bool needs_data(Cell corner) const {
    for (int row = corner.row; row < corner.row + tile_.cells(); ++row)
      for (int column = corner.column; column < corner.column + tile_.cells(); ++column)
        if (near_data({column, row})) return true;
    return false;
  }

  std::vector<TileSample> samples_around(Cell corner) const {
    const double cell_m = area_.geometry.resolution_m;
    const Vector2d low_m(corner.column * cell_m, corner.row * cell_m);
    const double side_m = tile_.cells() * cell_m;
    std::vector<TileSample> samples;
    for (const std::size_t i :
         bins_.in_box(low_m.array() - tile_.halo_m(), low_m.array() + side_m + tile_.halo_m())) {
      const Eigen::Array3d value =
          (survey_.fingerprints[i].field_uT.array() - h().mean_uT) / h().signal_sd_uT;
      samples.push_back({positions_m_[i] - low_m, value, 1.0});
    }
    return samples;
  }

  void put(FieldMap& map, std::size_t cell, int c, double mean, double variance) const {
    const double sd_uT = h().signal_sd_uT(c);
    const Eigen::Array3d variance_uT2 = Eigen::Array3d::Constant(sd_uT * sd_uT * std::min(variance, 1.0));
    map.mean_uT[cell](c) = static_cast<float>(h().mean_uT(c) + sd_uT * mean);
    map.variance_uT2[cell](c) = static_cast<float>(survey_.calibration.apply(variance_uT2)(c));
  }

  const SurveyAnalysis& survey_;
  const FieldArea& area_;
  std::vector<int> components_;
  std::vector<Vector2d> positions_m_;
  PointBins bins_;
  TileRegression tile_;
};

}  // namespace

void fill_by_gpr(const SurveyAnalysis& survey, const FieldArea& area, const FillOptions& options,
                 FieldMap& map) {
  for (const std::vector<int>& components : components_by_covariance(survey.hyperparameters.values)) {
    const TiledRegression regression(survey, area, options, components);
    regression.fill_prior(map);
    const std::vector<Cell> tiles = regression.tiles();
    Meter meter(options.progress, tiles.size());
    Spares<TileRegression::Workspace> workspaces;
    parallel_for(tiles.size(), options.threads, [&](std::size_t t) {
      auto workspace = workspaces.take();
      regression.fill(tiles[t], workspace, map);
      workspaces.give(std::move(workspace));
      meter.one_done();
    });
  }
}

}  // namespace mstsl
