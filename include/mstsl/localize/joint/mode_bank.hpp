#pragma once

#include <memory>
#include <vector>

#include "mstsl/core/parallel.hpp"
#include "mstsl/localize/joint/elsewhere.hpp"
#include "mstsl/localize/joint/maps.hpp"
#include "mstsl/localize/joint/mode.hpp"
#include "mstsl/localize/joint/step.hpp"
#include "mstsl/localize/motion_noise.hpp"

namespace mstsl::joint {

/// How scans count as evidence between modes. A map's errors (its cells, what was moved, people) are common
/// to all points on a wall and to all scans from one place, so scans count by how much new they show.
struct ScanEvidence {
  /// Natural log of the odds between a mode that fits (score 1) and one that does not (0), for all that is
  /// seen from one place: 60 beams are worth about 15, each at most about 2.5 (a wall or none).
  double log_odds = 40.0;
  /// A scan this far (m) from the last shows a new place: half the view of a corridor with doors.
  double new_after_m = 3.0;
  /// A mode whose scans fit no more, all of a sudden, is told so within this way (m): it is elsewhere, or
  /// somebody stands before the laser and will be gone.
  double sudden_after_m = 0.5;
  /// Differences in score up to this are the map's errors: they do not tell copies of a place apart.
  double tolerance = 0.06;
  /// What a scan scores at a place that is not on the map or was rebuilt.
  double elsewhere_score = 0.62;
  double spacing_m = 0.25;
  std::size_t max_points = 80;
};

struct BankOptions {
  FieldModel field;
  ScanEvidence scan;
  FitOptions fit;
  MotionNoise odometry;
  /// A station's log density counts this much: what the model does not know makes it too sure of itself.
  double field_temper = 0.35;
  /// The field of the first metres is that of a few things, which may have been moved. By it the likeliest
  /// places (so many, a building's twins) may together lose no more than this (natural log) against the best,
  /// and so much more with each metre since they were found: 3e-4, a third of the doubt that a claim of 0.999
  /// leaves, and as sure as ever after 20 m.
  std::size_t spared = 1000;
  double early_loss = 8.0;
  double early_loss_per_m = 0.7;
  /// How often, one in so many metres, the robot is carried off or something happens that no mode knows.
  double lost_every_m = 20'000.0;
  /// Probability that it was carried off while neither scan nor field came, or odometry began anew.
  double carried_in_the_dark = 0.02;
  /// "None of these" before anything is known.
  double elsewhere_prior = 0.02;
  /// Modes this improbable (natural log) against the best are dropped: "none of these" always holds more, and
  /// its search finds them again.
  double drop_below = -25.0;
  /// Fits are made after this much motion while modes are many, and at each step when few.
  double fit_every_m = 0.3;
  double fit_every_rad = radians(12.0);
  std::size_t few = 60;
  /// When few modes are left and a scan fits one of them worse than this, its surroundings are searched, and
  /// a pose there that scores so much more takes its place: a wheel slipped, or a turn was missed.
  double search_below = 0.7;
  double search_gain = 0.15;
  /// Two modes become one when the squared distance of their poses, in their common standard deviations, is
  /// less than this ...
  double merge_below = 1.0;
  /// ... and the one is no wider than this (m): the field map is taken as a plane over a mode's width.
  double widest_m = 0.22;
  Threads threads;
};

/// The posterior as a sum of Gaussian modes and "none of these".
class ModeBank {
 public:
  ModeBank(std::shared_ptr<const Maps> maps, const Eigen::Vector2d& magnetometer_m,
           const BankOptions& options);

  /// One step of the robot: motion, stations, scan.
  void advance(const Step& step);

  /// Gives most of the weight of "none of these" to the places that the scan allows.
  void add(const std::vector<WallFit>& places);
  /// The same for places that the field allows, found on a grid of such steps.
  void add(const std::vector<Pose2>& places, double step_m, double turn_rad);

  /// Best first. Their weights and elsewhere_share() sum to 1.
  const std::vector<Mode>& modes() const { return modes_; }
  double elsewhere_share() const;

  /// The score of the best mode at the last fit.
  double best_score() const { return best_score_; }

 private:
  void add_modes(std::vector<Mode> modes);
  void move(const Step& step);
  void weigh_by_field(const std::vector<Station>& stations);
  void spare_the_early();
  void weigh_by_scan(const PointSet& points_base_m);
  double evidence_score(const PointSet& points_base_m, const Pose2& map_T_base) const;
  std::vector<double> fit_all(const PointSet& points_base_m);
  void search_around(Mode& mode, double& score, const PointSet& points_base_m) const;
  void leak(const Step& step);
  void normalise();
  void merge();
  void drop();

  std::shared_ptr<const Maps> maps_;
  Eigen::Vector2d magnetometer_m_;
  BankOptions options_;
  std::vector<Mode> modes_;
  Elsewhere elsewhere_;
  double log_elsewhere_ = 0.0;
  double elsewhere_account_ = 0.0;  ///< as Mode::scan_account
  double best_score_ = 0.0;
  double since_fit_m_ = 0.0, since_fit_rad_ = 0.0;
  double since_evidence_m_;
  double since_merge_m_ = 0.0;
  double since_found_m_ = 0.0;
};

}  // namespace mstsl::joint
