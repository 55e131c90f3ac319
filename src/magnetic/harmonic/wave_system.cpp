#include "wave_system.hpp"

#include <cassert>
#include <complex>
#include <utility>

namespace mstsl {

using Complex = std::complex<double>;
using Eigen::Array3d;
using Eigen::Index;
using Wave = WaveBox::Wave;

void WaveSystem::assemble_waves(const WaveBox& box, const PotentialPart& part, const Array3d& information,
                                const SampleSums& sums) {
  const auto m = static_cast<Index>(box.waves.size());
  for (Index j = 0; j < m; ++j) {
    const Wave& wj = box.waves[static_cast<std::size_t>(j)];
    for (Index i = j; i < m; ++i) {
      const Wave& wi = box.waves[static_cast<std::size_t>(i)];
      const FieldProduct fields = product_of(wi, wj, information);
      const Complex same = 0.5 * fields.same * sums.weights.at(wi.a + wj.a, wi.b + wj.b);
      const Complex conjugate = 0.5 * fields.conjugate * sums.weights.at(wi.a - wj.a, wi.b - wj.b);
      precision_(2 * i, 2 * j) = conjugate.real() + same.real();
      precision_(2 * i, 2 * j + 1) = same.imag() - conjugate.imag();
      precision_(2 * i + 1, 2 * j) = same.imag() + conjugate.imag();
      precision_(2 * i + 1, 2 * j + 1) = conjugate.real() - same.real();
    }
    Complex value = 0.0;
    for (int c = 0; c < 3; ++c)
      value +=
          information(c) * field_of(wj, part, c) * sums.values[static_cast<std::size_t>(c)].at(wj.a, wj.b);
    rhs_(2 * j) = value.real();
    rhs_(2 * j + 1) = value.imag();
  }
}

/// Their rows come below those of the waves.
void WaveSystem::assemble_long_waves(const WaveBox& box, const PotentialPart& part,
                                     const Array3d& information, const SampleSums& sums) {
  const auto first = static_cast<Index>(2 * box.waves.size());
  for (Index u = 0; first + u < precision_.rows(); ++u)
    for (int c = 0; c < 3; ++c) {
      const LongTerm term = long_term(box, part, u, c);
      const double factor = information(c) * term.factor;
      if (factor == 0.0) continue;
      const WaveTable& long_sums = sums.long_sums[static_cast<std::size_t>(term.column)];
      for (Index j = 0; 2 * j < first; ++j) {
        const Wave& wave = box.waves[static_cast<std::size_t>(j)];
        const Complex sum = factor * field_of(wave, part, c) * long_sums.at(wave.a, wave.b);
        precision_(first + u, 2 * j) += sum.real();
        precision_(first + u, 2 * j + 1) += sum.imag();
      }
      for (Index v = 0; v <= u; ++v) {
        const LongTerm other = long_term(box, part, v, c);
        precision_(first + u, first + v) +=
            factor * other.factor * sums.long_products(term.column, other.column);
      }
      rhs_(first + u) += factor * sums.long_values(term.column, c);
    }
}

/// The normal equations of a Bayesian linear model with unit prior (R&W Eq. 2.8).
void WaveSystem::solve(const WaveBox& box, const PotentialPart& part, const Array3d& information,
                       const SampleSums& sums) {
  const auto unknowns = static_cast<Index>(2 * (box.waves.size() + box.long_waves.size()));
  precision_.setZero(unknowns, unknowns);
  rhs_.setZero(unknowns);
  assemble_waves(box, part, information, sums);
  assemble_long_waves(box, part, information, sums);
  precision_.diagonal().array() += 1.0;
  covariance_ = inverse_.invert(std::move(precision_));
  assert(covariance_ != nullptr);  // I + something positive: rounding alone cannot spoil it
  solution_ = *covariance_ * rhs_;
}

}  // namespace mstsl
