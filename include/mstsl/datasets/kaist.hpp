#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/datasets/dataset.hpp"
#include "mstsl/datasets/lattice_lanes.hpp"
#include "mstsl/datasets/rotation_fit.hpp"
#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl::datasets {

struct KaistOptions {
  RunOptions runs = {.count = 20,
                     .length_m = 12.0};  ///< half the walk is 31 m: longer runs would hardly differ
  LatticeOptions lattice;
  sim::RobotOptions robot = robot_with_real_magnetometer();
  double map_resolution_m = 0.05;
};

/// One half of the walk, how the phone was held as seen from the *other* half, and how well that fits here.
struct WalkHalf {
  std::vector<Fingerprint> rows;   ///< in the order walked; the field as the phone read it
  RotationFit fit;                 ///< survey axes from phone axes, from this half's own rows
  Eigen::Matrix3d survey_R_phone;  ///< the other half's fit: what is used for this half
  Eigen::Vector3d residual_uT;     ///< rms of the survey minus this half's rows turned by it
};

/// Calibrates how the walker held the phone. The survey's axes and the phone's are documented nowhere; each
/// half of the walk gets the rotation that best turns the other half's readings into the survey's, so that no
/// run is ever turned by a fit to its own readings. Errors: a walk that leaves the surveyed points.
Result<std::array<WalkHalf, 2>> calibrated_halves(std::span<const Fingerprint> walk,
                                                  std::span<const Fingerprint> survey);

/// The survey's points and the walk's rows, each with the field in the axes of the phone that measured it.
Result<std::vector<Fingerprint>> read_kaist_survey(const std::filesystem::path& file);
Result<std::vector<Fingerprint>> read_kaist_walk(const std::filesystem::path& file);

/// Real floor plan and field, simulated lidar and odometry, from
/// canlang/sjlee-s-Robust-Magnetic-Field-Positionig. `folder` holds N1-7F.json, batch.csv (the survey, a
/// lattice of 0.5 m) and sjlee_testdata_N1_20180723.csv (one walk of 63 m, of which the runs are stretches,
/// walked either way).
Result<Dataset> kaist_n1_7f(const std::filesystem::path& folder, const KaistOptions& options,
                            const Random& random);

}  // namespace mstsl::datasets
