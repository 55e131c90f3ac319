#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"
#include "mstsl/localize/initialise.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/localize/motion.hpp"
#include "mstsl/scan/local_map.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

/// Why a hypothesis was removed (paper section III-B and Fig. 4).
enum class Rejection { kOutOfMap, kCrossesWall, kLowScore };

/// "out_of_map", "crosses_wall" or "low_score".
std::string_view to_string(Rejection rejection);

struct LidarStageOptions {
  /// The local map is matched after so much motion (m, rad): a few per door or pillar.
  double match_every_m = 0.25;
  double match_every_rad = radians(20.0);
  /// The standard deviation of an initial position is taken as no less and no more than this, in m, before
  /// the window of 3 sigma is laid around it. No less: field maps claim too much. No more: a wider window
  /// reaches the next look-alike.
  double min_sigma_m = 0.3;
  double max_sigma_m = 1.0;
  OdometryNoise odometry;
  LocalMapOptions local_map;
  SubmapMatchOptions match{.score = {.unmapped_is_miss = false}};
  /// The paper's S below which a hypothesis is false.
  double min_score = kConfidenceThreshold;
  /// ... so many matches in a row: people walk by and cars come and go.
  int low_scores_to_reject = 3;
  /// Share of the scan evidence that is believed when hypotheses are weighed: the map's errors, unlike the
  /// laser's noise, are the same for every point on a wall.
  double likelihood_temper = 1.0;

  /// An answer is given when it holds so much of the weight of the hypotheses that are left: the paper's
  /// answer is the one that survives the others. "None of these" has no say in when, only in the probability
  /// ...
  double answer_share = 0.95;
  /// ... or when this distance, in m, was driven since the initial hypotheses, to the best that is left; the
  /// paper calls an answer after more than 10 m a failure.
  double answer_distance_m = 8.0;
  /// No answer before this distance, in m: a scan from one place does not tell look-alikes apart.
  double min_distance_m = 1.0;
  /// Never a higher probability than this. The paper's method has no measure of being right: it tests
  /// hypotheses against the walls but never those it did not think of. Its own success rates are 96 % and 92
  /// %.
  double max_probability = 0.95;
};

/// x_l^k: one hypothesis on its way from the initialisation to the answer.
struct LidarHypothesis {
  Pose2 map_T_start;  ///< the base at the first scan, by the field
  Eigen::Matrix3d start_covariance;
  double field_probability = 0.0;  ///< Eq. 1's first factor
  Pose2 map_T_base;                ///< now
  Eigen::Matrix3d covariance;
  double scan_log_likelihood = 0.0;  ///< Eq. 1's second factor, of the whole local map
  double score = 0.0;                ///< S at the last match
  int low_scores = 0;                ///< in a row
  std::optional<Rejection> rejected;
  double rejected_after_m = 0.0;  ///< driven since the initialisation
};

/// The LiDAR-based localization of section III-B: drives the hypotheses on by odometry, builds the local map,
/// matches it to the global map around each, and removes those that cannot be.
class LidarStage {
 public:
  /// `hypotheses` hold where the reading was taken, from where the base has moved by `reading_T_base` since.
  LidarStage(std::shared_ptr<const LocalizationMaps> maps, const std::vector<InitialHypothesis>& hypotheses,
             const Pose2& reading_T_base, const LidarStageOptions& options);

  /// A scan's returns in the base frame, and the base's motion since the last scan by odometry.
  void observe(const std::vector<BeamReturn>& returns_base, const Pose2& last_T_base);

  const std::vector<LidarHypothesis>& hypotheses() const { return hypotheses_; }
  double driven_m() const { return driven_m_; }
  bool all_rejected() const;

  /// The probability of each hypothesis, in their order: Eq. 1's product, normalised over those left and
  /// "none of these", and never more than LidarStageOptions::max_probability together. Removed ones have 0.
  std::vector<double> weights() const;

  struct Answer {
    Pose2 map_T_base;
    Eigen::Matrix3d covariance;
    double probability = 0.0;
  };
  /// The answer, once it is due.
  std::optional<Answer> answer() const;

 private:
  void move_hypotheses(const Pose2& moved, bool local_map_begins);
  void match_all(const PointSet& scan_points_base_m);
  void match(LidarHypothesis& hypothesis, const PointSet& local_points_base_m,
             const PointSet& scan_points_base_m);
  std::optional<Rejection> impossible(const LidarHypothesis& hypothesis) const;

  std::shared_ptr<const LocalizationMaps> maps_;
  LidarStageOptions options_;
  std::vector<LidarHypothesis> hypotheses_;
  LocalMap local_map_;
  std::vector<Pose2> local_path_;  ///< local_T_base at each match
  Pose2 unseen_motion_;            ///< since the last scan that saw something
  double driven_m_ = 0.0;
  double since_match_m_ = 0.0;
  double since_match_rad_ = 0.0;
  int matches_ = 0;
};

}  // namespace mstsl
