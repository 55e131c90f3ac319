#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/eval/metrics.hpp"
#include "mstsl/eval/run_trace.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/localize/methods.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/sim/drive.hpp"

namespace mstsl {

/// A log that can be played again and says the same each time; the truth apart from the events.
struct RecordedLog {
  Rig rig;
  std::function<void(const sim::DriveSinks&)> play;
};

/// A recorded building: surveys whose truth makes the field map, runs whose truth judges the answers.
struct RecordedCase {
  std::string name;
  OccupancyGrid map;
  std::vector<RecordedLog> surveys, runs;
};

struct RecordedOptions {
  std::vector<std::string> methods{"two-step", "joint"};
  MethodOptions method;
  FieldMapOptions field;
  Threads threads;
  /// Called now and then, by one thread at a time; false ends it.
  std::function<bool(double share)> progress;
};

/// One method in one case.
struct RecordedResult {
  std::string method;
  std::vector<RunEvaluation> runs;
};

struct RecordedOutcome {
  std::vector<RecordedResult> results;  ///< by method
  RunTrace trace;                       ///< of the first run
};

/// Maps the field from the surveys, then plays every run to all methods at once: they hear the same events.
/// The same result at any number of threads. Errors: a case without surveys or runs, a field map that cannot
/// be made, a method that is not there, an end asked for by `progress`.
Result<RecordedOutcome> run_recorded_case(const RecordedCase& recorded, const RecordedOptions& options);

}  // namespace mstsl
