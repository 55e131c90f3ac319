#pragma once

#include <filesystem>
#include <vector>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/datasets/dataset.hpp"
#include "mstsl/datasets/tubes.hpp"
#include "mstsl/magnetic/fingerprint.hpp"

namespace mstsl::datasets {

struct CeaCorridorOptions {
  RunOptions runs;
  TubeOptions corridor;
  sim::RobotOptions robot = robot_with_real_magnetometer();
  double longest_step_m = 0.5;  ///< rows farther apart than this do not belong to one drive (usual: 5-7 cm)
};

/// One pass of the data set CEA-LIST/large-scale-magnetic-mapping: a CSV file with columns x_m, y_m, z_m,
/// bx_uT, by_uT, bz_uT, the field calibrated and in the map frame. Errors as read_number_columns, and rows on
/// more than one floor.
Result<std::vector<Fingerprint>> read_cea_pass(const std::filesystem::path& file);

/// Real field, simulated lidar and odometry. `folder` holds floor_a_survey.csv, which becomes the survey, and
/// floor_a_query.csv, another pass through the same corridors, of which the runs are stretches.
Result<Dataset> cea_corridor(const std::filesystem::path& folder, const CeaCorridorOptions& options,
                             const Random& random);

}  // namespace mstsl::datasets
