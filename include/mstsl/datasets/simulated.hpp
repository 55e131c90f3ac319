#pragma once

#include <cstddef>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/datasets/dataset.hpp"
#include "mstsl/sim/run.hpp"
#include "mstsl/sim/survey.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::datasets {

/// What is recorded in a simulated building.
struct SimulatedOptions {
  sim::SurveyOptions survey;
  double survey_scan_hz =
      5.0;  ///< scans in the surveys' logs, a second; 0 for none. The field map needs none
  std::size_t runs = 10;
  sim::RunOptions run;
  sim::RobotOptions robot;         ///< of surveys and runs; each log draws its own errors
  double moved_fraction = 0.1;     ///< share of movable things that were decided anew between survey and runs
  bool turn_to_wall = true;        ///< runs begin with the commanded turn by beta (paper, section III-A.3)
  double map_resolution_m = 0.05;  ///< of the occupancy map (paper: 5 cm)
};

/// A simulated building as a data set: its map, surveys along all lanes on the first day, and runs from
/// random waypoints with random headings on a later one. Errors: those of survey_routes() and random_run(),
/// which say what to change.
Result<Dataset> simulated(const sim::World& world, const SimulatedOptions& options, const Random& random);

}  // namespace mstsl::datasets
