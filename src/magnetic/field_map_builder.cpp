#include "mstsl/magnetic/field_map_builder.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "field_area.hpp"
#include "field_models.hpp"

namespace mstsl {
namespace {

/// How far a fingerprint vouches for the model's field.
double support_m(const SurveyAnalysis& survey) {
  switch (survey.model) {
    case FieldModel::kBilinear:
      return survey.bilinear_spacing_m;
    case FieldModel::kFingerprint:
      return kFingerprintReach_m;
    case FieldModel::kGpr:
      break;
  }
  return survey.hyperparameters.values.length_scale_m.minCoeff();
}

void describe(const SurveyAnalysis& survey, FieldMap& map) {
  if (survey.model == FieldModel::kGpr) map.hyperparameters = to_named(survey.hyperparameters.values);
  if (survey.harmonic) {
    map.hyperparameters["harmonic_depth_m"] = survey.harmonic->depth_m;
    map.hyperparameters["harmonic_side"] = static_cast<double>(survey.harmonic->side);
  }
  if (survey.model == FieldModel::kBilinear)
    map.hyperparameters["lattice_spacing_m"] = survey.bilinear_spacing_m;
  const auto put = [&](const std::string& name, const Eigen::Array3d& values, const std::string& unit) {
    for (int c = 0; c < 3; ++c) map.hyperparameters[name + "_" + "xyz"[c] + unit] = values(c);
  };
  const VarianceCalibration& calibration = survey.calibration.of_variance;
  put("reading_even_sd", calibration.even_sd_uT, "_uT");
  put("reading_uneven_sd", calibration.uneven_sd_uT, "_uT");
  put("strength_power", calibration.power, "");
  map.hyperparameters["strength_radius_m"] = survey.calibration.strength_radius_m;
  if (survey.model == FieldModel::kGpr) put("variance_factor", calibration.factor, "");
  const auto put_score = [&](const std::string& name, const HeldOutScore& score) {
    if (score.errors == 0) return;
    put(name + "_rms", score.rms_uT, "_uT");
    put(name + "_within_1_sigma", score.within_1_sigma, "");
    put(name + "_within_2_sigma", score.within_2_sigma, "");
  };
  put_score("held_out", survey.held_out.same_floor);
  put_score("held_out_uncalibrated", survey.held_out.same_floor_before);
  put_score("between_lanes", survey.held_out.between_lanes);
  put_score("between_lanes_uncalibrated", survey.held_out.between_lanes_before);
}

/// Which drive came last within reach of each supported cell.
std::vector<std::int32_t> newest_drives(const FieldMap& map, double reach_m) {
  std::vector<std::int32_t> newest(map.geometry.size(), -1);
  for (int drive = 0; std::cmp_less(drive, map.drives.size()); ++drive) {
    std::vector<Fingerprint> own;
    for (const Fingerprint& f : map.fingerprints)
      if (f.session == drive) own.push_back(f);
    if (own.empty()) continue;
    const std::vector<float> distance_m =
        distances_to(own, map.geometry, reach_m + map.geometry.resolution_m);
    for (std::size_t i = 0; i < newest.size(); ++i)
      if (map.supported[i] != 0 && distance_m[i] <= reach_m) newest[i] = drive;
  }
  return newest;
}

}  // namespace

Result<FieldMap> build_field_map(const SurveyAnalysis& survey, const OccupancyGrid* area_grid,
                                 const FieldMapOptions& options) {
  const double far_m =
      std::max(kPriorBeyond * survey.hyperparameters.values.length_scale_m.maxCoeff(), support_m(survey)) +
      options.resolution_m;
  const auto area =
      make_field_area(survey.fingerprints, area_grid, options.resolution_m, options.reach_m, far_m);
  if (!area) return area.error();
  FieldMap map;
  map.model = survey.model;
  map.geometry = area->geometry;
  map.fingerprints = survey.fingerprints;
  const Eigen::Vector3f nothing = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  map.mean_uT.assign(map.geometry.size(), nothing);
  map.variance_uT2.assign(map.geometry.size(), nothing);
  map.supported.assign(map.geometry.size(), 0);
  describe(survey, map);
  switch (survey.model) {
    case FieldModel::kGpr:
      map.hyperparameters["distrusted_fingerprints"] = static_cast<double>(fill_by_gpr(
          survey, *area, {options.quality, options.heavy_tails, options.threads, options.progress}, map));
      break;
    case FieldModel::kBilinear:
      fill_by_bilinear(survey, *area, map);
      break;
    case FieldModel::kFingerprint:
      fill_by_fingerprint(survey, *area, map);
      break;
  }
  for (std::size_t i = 0; i < map.supported.size(); ++i)
    map.supported[i] =
        map.has_value(map.geometry.cell(i)) && static_cast<double>(area->distance_m[i]) <= support_m(survey);
  map.drives = options.drives;
  if (!map.drives.empty()) map.newest_drive = newest_drives(map, support_m(survey));
  return map;
}

Result<FieldMap> build_field_map(std::span<const Fingerprint> fingerprints, const OccupancyGrid* area,
                                 const FieldMapOptions& options) {
  SurveyAnalysisOptions analysis = options.analysis;
  analysis.threads = options.threads;
  const auto survey = analyse_survey(fingerprints, options.model, analysis);
  if (!survey) return survey.error();
  return build_field_map(*survey, area, options);
}

}  // namespace mstsl
