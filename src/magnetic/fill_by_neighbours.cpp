#include <limits>
#include <vector>

#include "bilinear_lattice.hpp"
#include "field_models.hpp"
#include "field_strength.hpp"
#include "point_bins.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;

/// Neither model knows a variance: every cell has that of the held-out lanes where the field is as strong.
void put(const SurveyAnalysis& survey, const FieldStrength& strength, const Eigen::Vector3d& mean_uT,
         std::size_t cell, FieldMap& map) {
  const double strength_here = strength.at(map.geometry.center_of(map.geometry.cell(cell)));
  map.mean_uT[cell] = mean_uT.cast<float>();
  map.variance_uT2[cell] =
      survey.calibration.of_variance.reading_variance_uT2(strength_here).matrix().cast<float>();
}

}  // namespace

void fill_by_bilinear(const SurveyAnalysis& survey, const FieldArea& area, FieldMap& map) {
  const GridGeometry& geometry = area.geometry;
  std::vector<Vector2d> positions;
  for (const Fingerprint& f : survey.fingerprints)
    positions.push_back(geometry.to_grid(f.position_m) * geometry.resolution_m);
  const BilinearLattice lattice(positions, survey.fingerprints, survey.bilinear_spacing_m);
  const FieldStrength strength = strength_of(survey);
  for (std::size_t i = 0; i < area.wanted.size(); ++i) {
    if (area.wanted[i] == 0) continue;
    const Cell cell = geometry.cell(i);
    const auto mean = lattice.at(Vector2d(cell.column + 0.5, cell.row + 0.5) * geometry.resolution_m);
    if (mean) put(survey, strength, *mean, i, map);
  }
}

void fill_by_fingerprint(const SurveyAnalysis& survey, const FieldArea& area, FieldMap& map) {
  std::vector<Vector2d> positions;
  for (const Fingerprint& f : survey.fingerprints) positions.push_back(f.position_m);
  const PointBins bins(positions, 0.25);
  const FieldStrength strength = strength_of(survey);
  for (std::size_t i = 0; i < area.wanted.size(); ++i) {
    const double reach_m = static_cast<double>(area.distance_m[i]) + 2.0 * area.geometry.resolution_m;
    if (area.wanted[i] == 0 || reach_m > kFingerprintReach_m) continue;
    const Vector2d center = area.geometry.center_of(area.geometry.cell(i));
    double nearest2 = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    bins.for_each_near(center.array() - reach_m, center.array() + reach_m, [&](std::size_t k) {
      const double distance2 = (positions[k] - center).squaredNorm();
      if (distance2 < nearest2) nearest2 = distance2, nearest = k;
    });
    if (nearest2 <= kFingerprintReach_m * kFingerprintReach_m)
      put(survey, strength, survey.fingerprints[nearest].field_uT, i, map);
  }
}

}  // namespace mstsl
