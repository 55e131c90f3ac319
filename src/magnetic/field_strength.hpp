#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/parallel.hpp"
#include "mstsl/magnetic/cross_validation.hpp"
#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/survey_analysis.hpp"

namespace mstsl {

/// How strong the field is around a place against the whole survey's: the mean, over the fingerprints within
/// about `radius_m`, of the squared deviation from `mean_uT` in units of `sd_uT`. Where there are none: 1.
class FieldStrength {
 public:
  FieldStrength(std::span<const Fingerprint> fingerprints, const Eigen::Array3d& mean_uT,
                const Eigen::Array3d& sd_uT, double radius_m);

  double at(const Eigen::Vector2d& map_point_m) const;

 private:
  struct Sums {
    float weight = 0.0f, squares = 0.0f;
  };
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  Sums& node(int column, int row) { return sums_[index(column, row)]; }
  const Sums& node(int column, int row) const { return sums_[index(column, row)]; }
  void blur(int nodes, bool along_rows);

  double step_m_;
  Eigen::Vector2d low_m_{0, 0};
  int columns_ = 0, rows_ = 0;
  std::vector<Sums> sums_;
};

/// The calibration under which held-out errors are most probable, over the radii to measure the field's
/// strength by; the errors are given their strengths.
LocalCalibration calibrate_locally(std::vector<HeldOutError>& errors,
                                   const std::vector<HeldOutStretch>& stretches,
                                   std::span<const Fingerprint> fingerprints, const Eigen::Array3d& mean_uT,
                                   const VarianceCalibration& prior, Threads threads);

/// The strength by which a survey's variance is calibrated.
FieldStrength strength_of(const SurveyAnalysis& survey);

}  // namespace mstsl
