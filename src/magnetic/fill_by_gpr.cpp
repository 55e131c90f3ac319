#include <algorithm>
#include <vector>

#include "field_models.hpp"
#include "field_strength.hpp"
#include "tile_engines.hpp"

namespace mstsl {

/// Length scales over which fingerprints are counted: half a tile.
constexpr double kDenseOver = 3.0;

std::size_t fill_by_gpr(const SurveyAnalysis& survey, const FieldArea& area, const FillOptions& options,
                        FieldMap& map) {
  const FieldHyperparameters& h = survey.hyperparameters.values;
  const auto positions_m = in_grid_frame(survey.fingerprints, area.geometry);
  std::vector<double> least_weight(survey.fingerprints.size(), 1.0);
  const double cell_m = area.geometry.resolution_m;
  const FieldStrength strength = strength_of(survey);
  const PutCell put = [&](std::size_t cell, int c, double mean_uT, double variance_uT2) {
    const double strength_here = strength.at(area.geometry.center_of(area.geometry.cell(cell)));
    map.mean_uT[cell](c) = static_cast<float>(mean_uT);
    map.variance_uT2[cell](c) =
        static_cast<float>(survey.calibration.of_variance.apply(c, variance_uT2, strength_here));
  };
  for (std::size_t cell = 0; cell < area.wanted.size(); ++cell)
    for (int c = 0; area.wanted[cell] != 0 && c < 3; ++c)
      put(cell, c, h.mean_uT(c), h.signal_sd_uT.square()(c));
  const auto fill = [&](const TileEngine& engine) {
    const std::vector<double> weights =
        fill_by_tiles(engine, survey.fingerprints, positions_m, area,
                      {options.heavy_tails, options.threads, options.progress}, put);
    for (std::size_t i = 0; i < weights.size(); ++i) least_weight[i] = std::min(least_weight[i], weights[i]);
  };
  if (survey.harmonic) {
    fill(HarmonicEngine(survey.fingerprints, *survey.harmonic, cell_m,
                        dense_samples_per_m2(positions_m, kDenseOver * h.length_scale_m(0)),
                        options.quality));
  } else {
    for (const std::vector<int>& components : components_by_covariance(h))
      fill(IndependentEngine(
          survey.fingerprints, h, components, cell_m,
          dense_samples_per_m2(positions_m, kDenseOver * h.length_scale_m(components.front())),
          options.quality));
  }
  return static_cast<std::size_t>(
      std::count_if(least_weight.begin(), least_weight.end(), [](double weight) { return weight < 0.5; }));
}

}  // namespace mstsl
