#pragma once

#include <cstddef>
#include <functional>

#include "mstsl/core/parallel.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/survey_analysis.hpp"
#include "mstsl/magnetic/tile_regression.hpp"

#include "field_area.hpp"

/// Each fills the wanted cells of a map (whose arrays are all NaN before) with the field by its model.
namespace mstsl {

struct FillOptions {
  RegressionQuality quality = RegressionQuality::kFast;
  bool heavy_tails = true;
  Threads threads;
  std::function<void(double)> progress;
};

/// Beyond this many length scales a fingerprint's covariance with a cell is below 0.0004 of the signal's
/// variance (of a harmonic covariance, whose tails are long: a tenth).
inline constexpr double kPriorBeyond = 4.0;

/// How many fingerprints turned out to be trusted less than half.
std::size_t fill_by_gpr(const SurveyAnalysis& survey, const FieldArea& area, const FillOptions& options,
                        FieldMap& map);
void fill_by_bilinear(const SurveyAnalysis& survey, const FieldArea& area, FieldMap& map);
void fill_by_fingerprint(const SurveyAnalysis& survey, const FieldArea& area, FieldMap& map);

}  // namespace mstsl
