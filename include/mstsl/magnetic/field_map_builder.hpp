#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/survey_analysis.hpp"
#include "mstsl/magnetic/tile_regression.hpp"

namespace mstsl {

struct FieldMapOptions {
  FieldModel model = FieldModel::kGpr;
  /// Side of a cell, in m (paper section III-A.2: 5 cm).
  double resolution_m = 0.05;
  /// Without an occupancy grid: how far from a fingerprint cells get a value, in m.
  double reach_m = 2.0;
  RegressionQuality quality = RegressionQuality::kFast;
  /// Whether fingerprints far from what all others say are trusted less (GPR only). Otherwise noise is
  /// Gaussian.
  bool heavy_tails = true;
  SurveyAnalysisOptions analysis;  ///< its `threads` is replaced by the one below
  Threads threads;
  /// The drives that the fingerprints' sessions count, if the map is to know them.
  std::vector<SurveyDrive> drives;
  /// Called now and then with the share of the work that is done, from one thread at a time.
  std::function<void(double)> progress;
};

/// The field on cells of 5 cm from a survey's fingerprints, by the model asked for: outliers dropped, a
/// significant bias removed, hyper-parameters learned, held-out lanes checked, then analysed survey -> map.
/// With an occupancy grid the cells lie along its axes and its free cells all get a value (the prior's where
/// no fingerprint is near). Errors: too few fingerprints, values that are not finite, a place too large for
/// memory.
Result<FieldMap> build_field_map(std::span<const Fingerprint> fingerprints, const OccupancyGrid* area,
                                 const FieldMapOptions& options = {});

/// The second half of the above, for callers who want to see the analysis.
Result<FieldMap> build_field_map(const SurveyAnalysis& survey, const OccupancyGrid* area,
                                 const FieldMapOptions& options);

}  // namespace mstsl
