#include "learning_blocks.hpp"

#include <algorithm>

#include "point_bins.hpp"

namespace mstsl {

using Eigen::Vector2d;

Moments moments_over_area(std::span<const Fingerprint> fingerprints, const std::vector<Vector2d>& points) {
  constexpr double kBin_m = 0.5;
  std::vector<Eigen::Array3d> means;
  for (const auto& bin : PointBins(points, kBin_m).occupied()) {
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (const std::size_t i : bin) sum += fingerprints[i].field_uT.array();
    means.push_back(sum / static_cast<double>(bin.size()));
  }
  const auto n = static_cast<double>(means.size());
  Eigen::Array3d mean = Eigen::Array3d::Zero(), variance = Eigen::Array3d::Zero();
  for (const auto& m : means) mean += m / n;
  for (const auto& m : means) variance += (m - mean).square() / std::max(n - 1.0, 1.0);
  constexpr double kLeast_uT = 0.05;  // a perfectly flat field: the quietest sensor's noise
  return {mean, variance.sqrt().max(kLeast_uT)};
}

std::vector<std::vector<Fingerprint>> learning_blocks(std::span<const Fingerprint> fingerprints,
                                                      double side_m, const LearningOptions& options) {
  std::vector<Vector2d> points;
  for (const Fingerprint& f : fingerprints) points.push_back(f.position_m);
  auto squares = PointBins(points, side_m).occupied();
  constexpr std::size_t kFewestInBlock = 40;
  const auto fewest = std::min(kFewestInBlock, fingerprints.size() / 2);
  std::erase_if(squares, [&](const auto& square) { return square.size() < fewest; });
  const std::size_t count = std::min(options.blocks, squares.size());
  std::vector<std::vector<Fingerprint>> blocks(count);
  for (std::size_t b = 0; b < count; ++b) {
    const auto& square = squares[b * squares.size() / count];
    const std::size_t stride = (square.size() + options.samples_per_block - 1) / options.samples_per_block;
    // Neighbours on a lane stay together in pairs: they tell noise from a rough field.
    for (std::size_t k = 0; k < square.size(); ++k)
      if ((k / 2) % stride == 0) blocks[b].push_back(fingerprints[square[k]]);
  }
  return blocks;
}

}  // namespace mstsl
