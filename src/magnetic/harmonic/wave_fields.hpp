#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "waves.hpp"

/// The field that a wave of the potential makes.
namespace mstsl {

/// Components that one potential ties together.
struct PotentialPart {
  Eigen::Array3d component;  ///< 1 for those that belong to it
  double vertical;           ///< sign of B_z
};
std::vector<PotentialPart> parts_of(SourceSide side);

/// Component c of a wave's field where its phase is zero, for the complex amplitude 1.
std::complex<double> field_of(const WaveBox::Wave& wave, const PotentialPart& part, int c);

/// Products of two waves' fields, weighted and summed over components: with and without conjugation of the
/// second. Both are real.
struct FieldProduct {
  double same, conjugate;
};
FieldProduct product_of(const WaveBox::Wave& i, const WaveBox::Wave& j, const Eigen::Array3d& weights);

/// Component c of the field of a long wave's unit amplitude: a factor of one column of long_waves_at(). First
/// the cosine amplitudes of all, then the sine amplitudes.
struct LongTerm {
  double factor;
  Eigen::Index column;
};
LongTerm long_term(const WaveBox& box, const PotentialPart& part, Eigen::Index unknown, int c);

/// Component c of each long wave's unit amplitudes, where their columns are given.
Eigen::MatrixXd long_fields(const WaveBox& box, const PotentialPart& part, int c,
                            const Eigen::MatrixXd& columns);

}  // namespace mstsl
