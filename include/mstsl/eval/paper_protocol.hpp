#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mstsl/core/crew.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/eval/metrics.hpp"
#include "mstsl/eval/run_trace.hpp"
#include "mstsl/eval/simulated_survey.hpp"
#include "mstsl/localize/two_step.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/sim/run.hpp"

namespace mstsl {

/// The paper's experiment (section IV) in one simulated world: survey, maps, ten starts driven ten times
/// each, in a closed loop: the robot sees its first scan, gets beta from it, and really turns by it.
struct PaperProtocolOptions {
  std::string world = "corridor";
  std::uint64_t seed = 1;
  int waypoints = 10;
  int runs_per_waypoint = 10;
  std::vector<FieldModel> models{FieldModel::kGpr, FieldModel::kBilinear, FieldModel::kFingerprint};
  SimulatedSurveyOptions survey;
  sim::RobotOptions robot;  ///< of the runs; its magnetometer's bias_sigma_uT is what calibration left
  sim::RunOptions run;
  /// Share of the things standing about (cars, cabinets, trolleys) that were moved between survey and runs.
  double moved_fraction = 0.1;
  TwoStepOptions two_step;  ///< K is set by `hypotheses`
  /// K; the paper's for the world if absent: 5 in the corridor, 8 elsewhere.
  std::optional<std::size_t> hypotheses;
  Criteria criteria;
  Threads threads;
  Crew crew;  ///< the processes that share the runs
  /// Finished runs are kept here, so that a protocol that was interrupted goes on; nothing is kept where it
  /// is empty. Taken up again are runs of the same `build` with the same world, seed, numbers of waypoints
  /// and runs, models, survey's fingerprints and lane spacing, bias, moved fraction and K.
  std::filesystem::path folder;
  std::string build;  ///< of the program
  /// Called now and then, by one thread at a time, with what is being done and its share; false ends the
  /// protocol.
  std::function<bool(const char* what, double share)> progress;
};

/// One run with one of the field models.
struct ProtocolRun {
  int waypoint = 0;
  int run = 0;
  FieldModel model = FieldModel::kGpr;
  /// The paper's "Ori. Adj.": how far from parallel (or square) to the building the robot stood after its
  /// turn, rad.
  double alignment_error_rad = 0.0;
  RunEvaluation evaluation;
};

struct ProtocolResult {
  std::string world;
  std::uint64_t seed = 0;
  std::size_t hypotheses = 0;  ///< K
  std::size_t fingerprints = 0;
  std::vector<FieldModel> models;
  std::vector<ProtocolRun> runs;  ///< by waypoint, run, model
  std::vector<Eigen::Vector2d> waypoints_m;
  std::shared_ptr<const TracedPlace> place;  ///< with the field by the first model
  std::vector<RunTrace> traces;  ///< of the first run from each waypoint, a method a model; the leader's only
};

/// How many fingerprints the paper's survey took of the place that a simulated world stands for; nothing for
/// the others.
std::optional<std::size_t> paper_fingerprints(std::string_view world);

/// Runs it. The same result at any number of threads and processes. Errors: a world that is not there, a
/// survey or map that cannot be made, or an end asked for by `progress`.
Result<ProtocolResult> run_paper_protocol(const PaperProtocolOptions& options);

}  // namespace mstsl
