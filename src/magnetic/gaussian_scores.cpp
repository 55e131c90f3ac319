#include "gaussian_scores.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

using Eigen::Index;

constexpr Index kChunk = 512;  // what one round of the formula needs stays in the first-level cache
using Chunk = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kChunk, 1>;

/// r^T S^-1 r and ln det S by the Cholesky factor of S = C + diag(variance), written out for 3 x 3 over many
/// cells.
void score(const PlaceFields& places, const FieldObservation& o, Index first, Index count,
           float* log_density) {
  const auto residual = [&](int c) -> Chunk {
    return o.field_uT(c) - places.mean_uT[c].segment(first, count).cast<double>();
  };
  const auto pivot = [&](int c) -> Chunk {
    return o.covariance_uT2(c, c) + places.variance_uT2[c].segment(first, count).cast<double>();
  };
  const Eigen::Matrix3d& s = o.covariance_uT2;
  const Chunk inverse_a = pivot(0).inverse();
  const Chunk l10 = s(1, 0) * inverse_a, l20 = s(2, 0) * inverse_a;
  const Chunk b = pivot(1) - s(1, 0) * l10;
  const Chunk inverse_b = b.inverse();
  const Chunk off = s(2, 1) - s(2, 0) * l10;
  const Chunk l21 = off * inverse_b;
  const Chunk c = pivot(2) - s(2, 0) * l20 - off * l21;
  const Chunk y0 = residual(0);
  const Chunk y1 = residual(1) - l10 * y0;
  const Chunk y2 = residual(2) - l20 * y0 - l21 * y1;
  const Chunk determinant = b * c / inverse_a;
  const double constant = 3.0 * std::log(2.0 * kPi);
  const Chunk distance = y0.square() * inverse_a + y1.square() * inverse_b + y2.square() / c;
  Eigen::Map<Eigen::ArrayXf>(log_density + first, count) =
      (-0.5 * (distance + determinant.log() + constant)).cast<float>();
}

}  // namespace

std::vector<float> gaussian_log_densities(const PlaceFields& places, const FieldObservation& observation,
                                          Threads threads) {
  std::vector<float> log_density(static_cast<std::size_t>(places.size()));
  constexpr Index kPart = 64 * kChunk;
  const auto parts = static_cast<std::size_t>((places.size() + kPart - 1) / kPart);
  parallel_for(parts, threads, [&](std::size_t part) {
    const Index end = std::min(places.size(), static_cast<Index>(part + 1) * kPart);
    for (Index first = static_cast<Index>(part) * kPart; first < end; first += kChunk)
      score(places, observation, first, std::min(kChunk, end - first), log_density.data());
  });
  return log_density;
}

}  // namespace mstsl
