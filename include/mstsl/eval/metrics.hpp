#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/eval/statistics.hpp"
#include "mstsl/localize/estimate.hpp"

namespace mstsl {

/// How far two poses are apart: position in m and the turn between them in rad, both >= 0.
struct PoseError {
  double position_m = 0.0;
  double yaw_rad = 0.0;
};

PoseError error_between(const Pose2& estimated, const Pose2& truth);

struct PoseBound {
  double position_m;
  double yaw_rad;
  bool holds(const PoseError& error) const {
    return error.position_m <= position_m && error.yaw_rad <= yaw_rad;
  }
};

/// What counts as right. The paper names bounds for the initialisation and for the distance driven only
/// (section IV-B.2); those of a pose are the project's own.
struct Criteria {
  PoseBound success{0.5, radians(10.0)};  ///< a pose is right
  PoseBound tight{0.2, radians(3.0)};     ///< a pose is right and good to drive by
  double initial_bound_m = 3.0;           ///< initialisation succeeded (paper IV-B.2)
  double max_distance_m = 10.0;           ///< an answer after a longer drive is a failure (paper IV-B.2)
  double max_truth_gap_s = 1.0;           ///< true poses further apart are not interpolated between
};

/// A pose that was published, held against the truth.
struct JudgedAnswer {
  double travelled_m = 0.0;
  double probability = 0.0;
  PoseError error;
  bool right = false;  ///< within Criteria::success
  bool tight = false;  ///< within Criteria::tight
  /// Normalised estimation error squared e' P^-1 e of x, y and yaw (Bar-Shalom et al. 2001, 5.4): chi-square
  /// with 3 degrees of freedom where the covariance P is true. Nothing where P is no covariance.
  std::optional<double> nees = {};
};

/// The first set of hypotheses, held against the truth at its stamp (paper Table I).
struct JudgedInitialisation {
  std::size_t hypotheses = 0;
  double best_error_m = 0.0;   ///< of the hypothesis nearest to the truth
  double first_error_m = 0.0;  ///< of the most probable one
  bool succeeded = false;      ///< best_error_m within Criteria::initial_bound_m
};

/// What one run's estimates are worth.
struct RunEvaluation {
  std::size_t estimates = 0;
  std::size_t without_truth = 0;  ///< estimates whose time the truth does not cover; they are not judged
  std::optional<JudgedInitialisation> initialisation;
  std::vector<JudgedAnswer> answers;  ///< every judged pose, in time order
  std::optional<JudgedAnswer> last;  ///< that of the last judged estimate; nothing if it ended without a pose
  std::optional<double>
      correct_distance_m;      ///< CLD: driven when the first right answer was given, if within the limit
  std::size_t times_lost = 0;  ///< how often the status turned to "lost"

  const JudgedAnswer* first() const { return answers.empty() ? nullptr : &answers.front(); }
  /// The strictest reading of a localized run: the first pose given was right, and given within the limit.
  bool succeeded() const;
};

/// Judges the estimates of one run (in time order) against the true poses of base_link in the map.
RunEvaluation evaluate_run(const std::vector<Estimate>& estimates, const Trajectory& truth,
                           const Criteria& criteria = {});

}  // namespace mstsl
