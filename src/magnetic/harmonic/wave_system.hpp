#pragma once

#include <Eigen/Core>

#include "../dense/spd_inverse.hpp"
#include "sample_sums.hpp"
#include "wave_fields.hpp"

namespace mstsl {

/// The posterior of the amplitudes of one part's waves. Unknowns: cosine and sine of each wave, in turn; then
/// the cosines of all long waves, then their sines. All have unit variance a priori.
class WaveSystem {
 public:
  /// `information`: one over the noise variance of each component, 0 for those that the part does not have.
  void solve(const WaveBox& box, const PotentialPart& part, const Eigen::Array3d& information,
             const SampleSums& sums);

  const Eigen::VectorXd& solution() const { return solution_; }
  const Eigen::MatrixXd& covariance() const { return *covariance_; }

 private:
  void assemble_waves(const WaveBox& box, const PotentialPart& part, const Eigen::Array3d& information,
                      const SampleSums& sums);
  void assemble_long_waves(const WaveBox& box, const PotentialPart& part, const Eigen::Array3d& information,
                           const SampleSums& sums);

  SpdInverse inverse_;
  Eigen::MatrixXd precision_;
  Eigen::VectorXd rhs_, solution_;
  const Eigen::MatrixXd* covariance_ = nullptr;
};

}  // namespace mstsl
