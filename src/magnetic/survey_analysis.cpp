#include "mstsl/magnetic/survey_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "mstsl/magnetic/predictors.hpp"
#include "mstsl/magnetic/tile_regression.hpp"

#include "bilinear_lattice.hpp"
#include "choose_kernel.hpp"
#include "field_strength.hpp"
#include "harmonic/dense.hpp"
#include "noise_by_lane.hpp"

namespace mstsl {
namespace {

using Eigen::Array3d;

std::optional<Error> refusal(std::span<const Fingerprint> fingerprints) {
  if (fingerprints.empty())
    return Error("the survey holds no fingerprint; are the pose and field topics the right ones?");
  constexpr double kMaxCoordinate_m = 1e7;  // larger ones lose the millimetre
  for (std::size_t i = 0; i < fingerprints.size(); ++i) {
    const Fingerprint& f = fingerprints[i];
    if (!f.position_m.allFinite() || !f.field_uT.allFinite() || !std::isfinite(f.heading_rad))
      return Error(fmt::format("fingerprint {} holds a value that is not finite", i));
    if (f.position_m.cwiseAbs().maxCoeff() > kMaxCoordinate_m)
      return Error(fmt::format("fingerprint {} lies at ({:g}, {:g}) m, further out than {:g} m", i,
                               f.position_m.x(), f.position_m.y(), kMaxCoordinate_m));
    if (f.session < 0) return Error(fmt::format("fingerprint {} belongs to session {}", i, f.session));
  }
  return std::nullopt;
}

void drop_outliers(SurveyAnalysis& analysis, const OutlierOptions& options) {
  const std::vector<std::size_t> outliers = find_outliers(analysis.fingerprints, options);
  analysis.outliers = outliers.size();
  std::vector<Fingerprint> kept;
  std::size_t next = 0;
  for (std::size_t i = 0; i < analysis.fingerprints.size(); ++i) {
    if (next < outliers.size() && outliers[next] == i)
      ++next;
    else
      kept.push_back(analysis.fingerprints[i]);
  }
  analysis.fingerprints = std::move(kept);
}

void treat_bias(SurveyAnalysis& analysis, const SurveyAnalysisOptions& options) {
  analysis.bias = estimate_survey_bias(analysis.fingerprints, options.bias);
  const bool wanted =
      options.bias_removal == BiasRemoval::kWhenSignificant && analysis.bias.any_significant();
  analysis.bias_removed = wanted || options.bias_removal == BiasRemoval::kAlways;
  if (analysis.bias_removed) remove_bias(analysis.fingerprints, analysis.bias);
  if (analysis.bias.pairs == 0)
    analysis.warnings.push_back(
        "no lane was driven in two directions: a bias of the magnetometer stays in the map, unseen");
}

Result<LearnedHyperparameters> hyperparameters_for(const SurveyAnalysis& analysis,
                                                   const SurveyAnalysisOptions& options) {
  if (options.harmonic && analysis.model == FieldModel::kGpr)
    return LearnedHyperparameters{as_independent(*options.harmonic), 0, 0, 0.0, {}};
  if (!options.hyperparameters) {
    LearningOptions learning = options.learning;
    learning.threads = options.threads;
    auto learned = learn_hyperparameters(analysis.fingerprints, learning);
    if (learned && options.noise_from_lanes && analysis.model == FieldModel::kGpr)
      learned->values = noise_from_lanes(analysis.fingerprints, learned->values, options.threads);
    return learned;
  }
  const FieldHyperparameters& given = *options.hyperparameters;
  if (!is_valid(given))
    return Error("the hyper-parameters given hold a scale that is not positive and finite");
  if ((given.noise_sd_uT < TileRegression::kMinNoiseRatio * given.signal_sd_uT).any())
    return Error(
        fmt::format("the noise given is below {} % of the signal; the regression cannot resolve that",
                    100 * TileRegression::kMinNoiseRatio));
  return LearnedHyperparameters{given, 0, 0, 0.0, {}};
}

Predictor predictor_for(const SurveyAnalysis& analysis) {
  switch (analysis.model) {
    case FieldModel::kBilinear:
      return bilinear_predictor(analysis.bilinear_spacing_m);
    case FieldModel::kFingerprint:
      return nearest_predictor(kFingerprintReach_m);
    case FieldModel::kGpr:
      break;
  }
  return analysis.harmonic ? harmonic_predictor(*analysis.harmonic)
                           : gpr_predictor(analysis.hyperparameters.values);
}

/// Replaces independent components by the harmonic covariance where that is wanted.
Result<void> choose_kernel(SurveyAnalysis& analysis, const SurveyAnalysisOptions& options) {
  if (analysis.model != FieldModel::kGpr) return {};
  if (options.harmonic) {
    analysis.harmonic = options.harmonic;
    return {};
  }
  if (options.kernel == KernelChoice::kSquaredExponential) return {};
  if (options.hyperparameters) {
    if (options.kernel == KernelChoice::kAuto) return {};
    return Error("hyper-parameters of a squared exponential were given for a harmonic covariance");
  }
  LearningOptions learning = options.learning;
  learning.threads = options.threads;
  analysis.kernel_comparison =
      compare_kernels(analysis.fingerprints, analysis.hyperparameters.values, learning);
  if (!analysis.kernel_comparison) {
    if (options.kernel == KernelChoice::kAuto) return {};
    return Error("the survey is too small to learn a harmonic covariance from; drive a longer one");
  }
  if (options.kernel == KernelChoice::kAuto && !analysis.kernel_comparison->favours_harmonic()) return {};
  analysis.harmonic = analysis.kernel_comparison->harmonic;
  analysis.hyperparameters.values = as_independent(*analysis.harmonic);
  return {};
}

/// What lanes left out say of the model, and the calibration that follows.
void check_by_lane(SurveyAnalysis& analysis, const SurveyAnalysisOptions& options) {
  const FieldHyperparameters& h = analysis.hyperparameters.values;
  const double length_m = h.length_scale_m.maxCoeff();
  HoldOutWays ways = hold_out_ways(
      length_m, analysis.model == FieldModel::kFingerprint ? 0.5 * kFingerprintReach_m : 0.5 * length_m);
  if (analysis.harmonic) ways.same_floor.training = ways.between_lanes.training = kHarmonicTraining;
  std::vector<HeldOutStretch> stretches = hold_out_lanes(analysis.fingerprints, ways.same_floor);
  const std::size_t over_same_floor = stretches.size();
  for (HeldOutStretch& stretch : hold_out_lanes(analysis.fingerprints, ways.between_lanes))
    stretches.push_back(std::move(stretch));
  std::vector<HeldOutError> errors =
      held_out_errors(analysis.fingerprints, stretches, predictor_for(analysis), options.threads);
  const VarianceCalibration before = uncalibrated(h.noise_sd_uT, h.signal_sd_uT);
  analysis.calibration = {before, 0.0};
  if (options.calibrate_variance)
    analysis.calibration =
        calibrate_locally(errors, stretches, analysis.fingerprints, h.mean_uT, before, options.threads);
  const auto between = std::ranges::partition_point(
      errors, [&](const HeldOutError& e) { return e.stretch < over_same_floor; });
  const std::span same_floor_errors(errors.begin(), between), between_errors(between, errors.end());
  const VarianceCalibration& after = analysis.calibration.of_variance;
  analysis.held_out = {score(same_floor_errors, before), score(same_floor_errors, after),
                       score(between_errors, before), score(between_errors, after)};
  if (errors.empty())
    analysis.warnings.push_back(
        "the survey is too short to leave a lane out: the map's variance could not be checked");
}

}  // namespace

Result<SurveyAnalysis> analyse_survey(std::span<const Fingerprint> fingerprints, FieldModel model,
                                      const SurveyAnalysisOptions& options) {
  if (auto error = refusal(fingerprints)) return *error;
  SurveyAnalysis analysis;
  analysis.model = model;
  analysis.fingerprints.assign(fingerprints.begin(), fingerprints.end());
  drop_outliers(analysis, options.outliers);
  treat_bias(analysis, options);
  auto learned = hyperparameters_for(analysis, options);
  if (!learned) return learned.error();
  analysis.hyperparameters = std::move(*learned);
  if (const auto chosen = choose_kernel(analysis, options); !chosen) return chosen.error();
  analysis.bilinear_spacing_m = options.bilinear_spacing_m.value_or(lane_spacing_m(analysis.fingerprints));
  if (!(analysis.bilinear_spacing_m > 0.0)) return Error("the bilinear lattice needs a positive spacing");
  const auto& doubts = analysis.hyperparameters.warnings;
  analysis.warnings.insert(analysis.warnings.end(), doubts.begin(), doubts.end());
  check_by_lane(analysis, options);
  return analysis;
}

}  // namespace mstsl
