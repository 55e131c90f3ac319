#pragma once

#include <filesystem>

#include "mstsl/core/result.hpp"
#include "mstsl/datasets/dataset.hpp"
#include "mstsl/datasets/tubes.hpp"

namespace mstsl::datasets {

/// Recordings of AaltoML/magnetic-data (Solin et al., IEEE T-RO 34(4), 2018): a robot with a calibrated
/// magnetometer under motion capture, nine drives of three minutes in 6 x 6 m. `folder` holds N-loc.csv (x, y
/// in m), N-mag.csv (uT, the robot's heading removed) and N-time.csv (s), row by row one reading. Drives 1 to
/// 4 become the surveys, 5 to 9 the checks; before 6 to 9 steel shelves were brought in. There are no runs:
/// no lidar, no odometry, no heading. The map is free within half of `area`'s width of a drive. Errors: a
/// file that cannot be read, files of one drive with different numbers of rows.
Result<Dataset> aalto_robot(const std::filesystem::path& folder, const TubeOptions& area = {});

}  // namespace mstsl::datasets
