#pragma once

#include <vector>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/sim/drive.hpp"
#include "mstsl/sim/robot.hpp"
#include "mstsl/sim/survey.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl {

struct SimulatedSurveyOptions {
  sim::SurveyOptions survey;
  sim::RobotOptions robot;
  /// Error of the surveyed positions, in m per axis, slowly changing along the way: the paper's come from a
  /// particle filter on the LiDAR, which is good to a few centimetres.
  double position_sigma_m = 0.03;
  /// Way over which that error forgets itself, in m.
  double position_error_length_m = 1.0;
  /// The field that the magnetometer meets; the world's own where empty.
  sim::FieldSource field;
  Threads threads;
};

/// Drives a survey and collects its fingerprints (paper section III-A.2), one session a log, in the order of
/// the logs. Errors: those of sim::survey_routes().
Result<std::vector<Fingerprint>> simulate_survey(const sim::World& world,
                                                 const SimulatedSurveyOptions& options, const Random& random);

}  // namespace mstsl
