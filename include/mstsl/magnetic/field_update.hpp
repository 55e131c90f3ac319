#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/field_check.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/survey_analysis.hpp"

namespace mstsl {

struct FieldUpdateOptions {
  /// A map's errors are alike along so much of a drive, in m: a stretch of this length is judged as one.
  double stretch_m = 1.0;
  /// How far off a drive's places are, in m, in each direction: what tracking by scans leaves. Where the
  /// field is steep this makes most of the error.
  double place_sd_m = 0.03;
  /// Changed is a stretch whose root mean square error is so many standard deviations of what the map and the
  /// places allow, and so many times what is usual on that drive.
  double changed_sigmas = 3.0;
  /// A drive whose usual square error is more than this share of the field's own variance along it is of
  /// another building: to know nothing of the field would give 1, to expect another one 2.
  double unexplained_share = 0.5;
};

/// A stretch of a drive where the field is no longer what it was.
struct FieldChange {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();
  double length_m = 0.0;
  Eigen::Array3d rms_uT = Eigen::Array3d::Zero();  ///< of measured minus foretold
};

/// What a drive says of a map that was made without it.
struct DriveComparison {
  int session = 0;
  FieldCheck check;  ///< with the bias taken out
  Eigen::Vector3d base_bias_uT =
      Eigen::Vector3d::Zero();  ///< of its magnetometer against the map's, in the base's frame
  double compared_m = 0.0;      ///< driven over ground that the map knows
  double new_m = 0.0;           ///< and over ground that it does not
  double changed_m = 0.0;
  double usual_sigmas = 0.0;  ///< median over the stretches of the error, in standard deviations
  double unexplained = 0.0;   ///< median square of the error by the median square of the foretold field's
                              ///< departure from its mean
  std::vector<FieldChange> changes;
  std::string refused;  ///< why the drive is not used; empty where it is
};

/// A map's survey brought up to date by drives that are newer than all of it.
struct FieldUpdate {
  std::vector<Fingerprint> fingerprints;      ///< what the new map is made of: what still holds, what is new
  std::vector<ReplacedFingerprint> replaced;  ///< now and before
  std::size_t replaced_now = 0;
  std::size_t added = 0;                ///< new fingerprints among them
  std::size_t confirming = 0;           ///< new ones that say what the map knows already, and are not kept
  std::vector<DriveComparison> drives;  ///< by session, from the first new one on
};

/// Compares drives with a map and merges them. Where a stretch contradicts the map, the old fingerprints that
/// lie nearer to it than to any other of the new ones, and not further than the field's length scale, are
/// taken out and kept as replaced. New fingerprints are added where none that still holds lies within a
/// quarter of that length: nearer, the field is the same to 3 % and a tracked place is worth less than a
/// surveyed one; so a place that is driven every day does not make the map grow. A constant bias of each
/// drive's magnetometer against the map is estimated (robustly) and taken from it.
///
/// `drives` are finite; their sessions count on from the map's. Errors: a map without its fingerprints;
/// drives of which none can be used. A drive that does not touch the map, or contradicts it everywhere, is
/// left out (DriveComparison::refused says why) as long as there is another.
Result<FieldUpdate> update_survey(const FieldMap& map, std::span<const Fingerprint> drives,
                                  const FieldUpdateOptions& options = {});

/// Which drive came last to each cell: what `made` says of the fingerprints that it is made of, what the map
/// before said, and the drives, also where they only confirmed it.
std::vector<std::int32_t> newest_drives(const FieldMap& made, const FieldMap& before,
                                        std::span<const Fingerprint> drives);

/// How the updated survey is to be analysed: with the covariance, or the lattice, that the map was made with,
/// for a few new drives say little of a building's statistics and should not change all of its map; and no
/// bias removed, for that was done. What the map does not say is learned anew.
SurveyAnalysisOptions analysis_as_before(const FieldMap& map);

}  // namespace mstsl
