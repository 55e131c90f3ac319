#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mstsl/grid/grid.hpp"
#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl {

/// How the field between the fingerprints was made (paper section III-A.2).
enum class FieldModel { kGpr, kBilinear, kFingerprint };

std::string_view to_string(FieldModel model);
std::optional<FieldModel> field_model_from(std::string_view name);

/// The magnetic field database m^B: on each cell the field in the map frame with its variance, and whether a
/// fingerprint supports it. Cells without a value hold NaN and support 0. The variance is that of what a
/// later, calibrated reading would show there (R&W Eq. 2.26 plus the noise), so that a consumer adds only its
/// own sensor's.
struct FieldMap {
  GridGeometry geometry;
  std::vector<Eigen::Vector3f> mean_uT;
  std::vector<Eigen::Vector3f> variance_uT2;
  std::vector<std::uint8_t> supported;  ///< 1 where a fingerprint lies within the model's reach

  FieldModel model = FieldModel::kGpr;
  double height_m = 0.0;                          ///< of the magnetometer above the floor, 0 if unknown
  std::map<std::string, double> hyperparameters;  ///< by name with unit: "length_scale_x_m", ...
  std::vector<std::string> provenance;            ///< the logs and options it was made from
  std::vector<Fingerprint> fingerprints;          ///< the survey itself: to update the map, and to answer by
  std::vector<SurveyDrive> drives;         ///< by Fingerprint::session; none where the map does not say
  std::vector<std::int32_t> newest_drive;  ///< of each cell that is supported, else -1; empty without drives
  std::vector<ReplacedFingerprint> replaced;  ///< what an update took out, and why

  bool has_value(Cell cell) const;

  /// Mean and variance at a point, bilinear between cell centres; nothing where a neighbour has no value.
  std::optional<FieldPrediction> at(const Eigen::Vector2d& map_point_m) const;
};

}  // namespace mstsl
