#pragma once

#include <array>
#include <vector>

#include "mstsl/eval/metrics.hpp"

namespace mstsl {

/// Of the answers whose stated probability of being right lies in [low, high): how many there are, what they
/// claim on average, and how many were right. Honest numbers have mean_claim near right.share().
struct ReliabilityBin {
  double low = 0.0;
  double high = 0.0;
  double mean_claim = 0.0;
  Rate right;
};

/// How true the stated probabilities are.
struct Calibration {
  std::vector<ReliabilityBin> bins;  ///< only those that hold an answer
  double brier = 0.0;                ///< mean squared difference of probability and outcome; 0 is perfect
  Rate wrong_at_99;                  ///< of the answers claimed at >= 0.99: the wrong ones
  Rate wrong_at_999;                 ///< of the answers claimed at >= 0.999: the wrong ones
};

/// Answers of one run follow from one another, so a calibration over runs takes one answer of each.
Calibration calibrate(const std::vector<JudgedAnswer>& answers);

/// How true the stated covariances are, over poses that were right.
struct Consistency {
  std::size_t poses = 0;     ///< with a covariance
  double mean_nees = 0.0;    ///< 3 where covariances are true; more: they are too small
  double median_nees = 0.0;  ///< 2.37 where they are
  Rate within_95;            ///< of the poses: those with a NEES below the 95 % bound of chi-square, 7.81
};

/// Poses that are wrong are not judged: what they are worth, the probability says.
Consistency consistency(const std::vector<JudgedAnswer>& answers);

/// All runs of one method in one world.
struct Summary {
  std::size_t runs = 0;
  Rate initialised;        ///< a hypothesis within 3.0 m, of all runs
  Rate initialised_first;  ///< the most probable hypothesis within 3.0 m
  Rate answered;           ///< a pose was given at all
  Rate success;            ///< RunEvaluation::succeeded()
  Rate tight_success;      ///< ... and the first pose was within the tight bound
  Rate final_success;      ///< the run's last estimate had a right pose
  Rate final_tight;
  Rate runs_wrong_at_99;  ///< runs that published any wrong pose at >= 0.99
  Rate runs_wrong_at_999;
  Spread initial_error_m;  ///< of the best hypothesis, over the runs that had any
  Spread first_error_m, first_error_yaw_rad;
  Spread final_error_m, final_error_yaw_rad;
  Spread correct_distance_m;  ///< CLD of the runs that have one
  Calibration first_answers;  ///< one answer a run
  Calibration all_answers;    ///< every pose published
  Consistency covariances;    ///< of every right pose published
  std::size_t times_lost = 0;
  std::size_t without_truth = 0;
};

Summary summarise(const std::vector<RunEvaluation>& runs, const Criteria& criteria = {});

}  // namespace mstsl
