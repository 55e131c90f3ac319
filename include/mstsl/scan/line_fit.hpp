#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "mstsl/core/random.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

/// How fit_line() searches.
struct LineFitOptions {
  /// A point this near the line lies on it (m). Three times the range noise of a UTM-30LX (10 mm below 10 m,
  /// data sheet) and the unevenness of a plastered wall.
  double inlier_distance_m = 0.03;
  /// Points nearer each other than this count once (m), so that the longest wall wins, not the nearest. 0:
  /// all count, as in the paper's text.
  double spacing_m = 0.02;
  /// Fewer inliers than this are no line.
  std::size_t min_inliers = 20;
  /// A line shorter than this between its outermost inliers gives no direction worth turning by (m).
  double min_length_m = 0.5;
  /// Draws end when a better line has been missed with no more than this probability (Fischler & Bolles, Eq.
  /// for k).
  double miss_probability = 1e-4;
  /// Never more draws than this: 3,000 find a line with a 5.5 % share of the points with the probability
  /// above.
  int max_draws = 3000;
};

/// A straight line in the plane and how well it is supported.
struct LineFit {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();  ///< mean of the inliers
  double angle_rad = 0.0;        ///< of its direction, in (-pi/2, pi/2]: a line has no front
  double angle_sigma_rad = 0.0;  ///< standard deviation of the angle from the residuals, points independent
  std::size_t inliers = 0;       ///< after thinning
  double inlier_share = 0.0;     ///< of the thinned points
  double residual_rms_m = 0.0;   ///< distance of the inliers from the line
  double length_m = 0.0;         ///< between the outermost inliers

  /// Perpendicular distance of a point (m, >= 0).
  double distance_m(const Eigen::Vector2d& point_m) const;
};

/// The line with the most inliers (RANSAC, Fischler & Bolles 1981; the paper's Sec. III-A.3), then refined by
/// total least squares over its inliers. Nothing when the points hold no line that meets the options.
std::optional<LineFit> fit_line(const PointSet& points_m, const LineFitOptions& options, Random& random);

/// The paper's beta for a line fitted in the base frame: by how much to turn (rad, counter-clockwise, in
/// (-pi/2, pi/2]) so that the robot's x axis becomes parallel to the line.
double turn_parallel_to(const LineFit& line_in_base);

/// The smallest turn (rad, in (-pi/4, pi/4]) after which the robot is parallel *or* perpendicular to the
/// line: enough in a building of right angles, whose body axes lie every 90 degrees.
double turn_square_to(const LineFit& line_in_base);

}  // namespace mstsl
