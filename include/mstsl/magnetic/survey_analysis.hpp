#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/cross_validation.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/harmonic_covariance.hpp"
#include "mstsl/magnetic/hyperparameters.hpp"
#include "mstsl/magnetic/learn_hyperparameters.hpp"
#include "mstsl/magnetic/outliers.hpp"
#include "mstsl/magnetic/survey_bias.hpp"
#include "mstsl/magnetic/variance_calibration.hpp"

namespace mstsl {

/// Whether a bias found in the survey is taken from its fingerprints.
enum class BiasRemoval { kWhenSignificant, kAlways, kNever };

/// The covariance of the GPR model: three independent squared exponentials (the paper's), the harmonic one,
/// or whichever foretells held-out lanes better.
enum class KernelChoice { kSquaredExponential, kHarmonic, kAuto };

struct SurveyAnalysisOptions {
  OutlierOptions outliers;
  SurveyBiasOptions bias;
  BiasRemoval bias_removal = BiasRemoval::kWhenSignificant;
  KernelChoice kernel = KernelChoice::kAuto;
  /// What the GPR assumes; learned from the fingerprints where absent. Given ones are a squared
  /// exponential's.
  std::optional<FieldHyperparameters> hyperparameters;
  /// The same for the harmonic covariance, in place of all of these.
  std::optional<HarmonicHyperparameters> harmonic;
  LearningOptions learning;
  /// Whether the noise is raised from what the marginal likelihood makes of single passes to what predicts
  /// held-out lanes best. Passes over the same floor differ by more than their readings' noise: position,
  /// heading, moved things.
  bool noise_from_lanes = true;
  /// Distance of the bilinear model's lattice nodes, in m; that of the lanes where absent.
  std::optional<double> bilinear_spacing_m;
  /// Whether the map's variance is corrected to what held-out lanes show. Otherwise it is the regression's
  /// own, with the noise of its fingerprints.
  bool calibrate_variance = true;
  Threads threads;
};

/// Held-out lanes, predicted twice: with the passes of other lanes that lie close by (what a second drive
/// over the same floor would find), and without anything within about half a length scale (what lies between
/// lanes).
struct HeldOutReport {
  HeldOutScore same_floor_before, same_floor;        ///< with the variance before and after calibration
  HeldOutScore between_lanes_before, between_lanes;  ///< the same
};

/// What the harmonic covariance gains over independent components on the same held-out fingerprints, under
/// the calibration that suits each.
struct KernelComparison {
  HarmonicHyperparameters harmonic;
  double gain = 0.0;     ///< of the log density of a fingerprint's three components, mean
  double gain_sd = 0.0;  ///< standard error of the mean, over held-out stretches
  Eigen::Array3d rms_independent_uT = Eigen::Array3d::Zero(), rms_harmonic_uT = Eigen::Array3d::Zero();

  /// More than chance alone would give once in forty times.
  bool favours_harmonic() const { return gain > 2.0 * gain_sd; }
};

/// A survey made ready for a map: cleaned, its bias removed, its statistics learned and checked.
struct SurveyAnalysis {
  FieldModel model = FieldModel::kGpr;
  std::vector<Fingerprint> fingerprints;  ///< what is left to build from
  std::size_t outliers = 0;               ///< dropped
  SurveyBias bias;
  bool bias_removed = false;
  LearnedHyperparameters hyperparameters;           ///< of the harmonic covariance: what resembles it
  std::optional<HarmonicHyperparameters> harmonic;  ///< the covariance, where it was chosen
  std::optional<KernelComparison> kernel_comparison;
  double bilinear_spacing_m = 0.0;
  HeldOutReport held_out;
  LocalCalibration calibration;  ///< from the model's variance to that of a later reading
  std::vector<std::string> warnings;
};

/// The furthest that the fingerprint model looks for a fingerprint, in m: half the widest lane distance in
/// use (1 m).
inline constexpr double kFingerprintReach_m = 0.5;

/// Errors: too few fingerprints, values that are not finite or no field found on Earth, hyper-parameters that
/// are no such.
Result<SurveyAnalysis> analyse_survey(std::span<const Fingerprint> fingerprints, FieldModel model,
                                      const SurveyAnalysisOptions& options = {});

}  // namespace mstsl
