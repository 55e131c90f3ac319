#include "mstsl/scan/line_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// A line as its points p: normal . p = offset.
struct Line {
  Eigen::Vector2d normal;
  double offset_m;

  double distance_m(const Eigen::Vector2d& p) const { return std::abs(normal.dot(p) - offset_m); }
};

std::optional<Line> line_through(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double length = (b - a).norm();
  if (!(length > 1e-9)) return std::nullopt;
  const Eigen::Vector2d along = (b - a) / length;
  const Eigen::Vector2d normal(-along.y(), along.x());
  return Line{normal, normal.dot(a)};
}

PointSet inliers_of(const Line& line, const PointSet& points, double tolerance_m) {
  PointSet inliers;
  std::copy_if(points.begin(), points.end(), std::back_inserter(inliers),
               [&](const Eigen::Vector2d& p) { return line.distance_m(p) <= tolerance_m; });
  return inliers;
}

/// How many draws of two points until two inliers were among them with all but `miss_probability`.
double draws_needed(double inlier_share, double miss_probability) {
  const double both_inliers = inlier_share * inlier_share;
  if (both_inliers >= 1.0) return 1.0;
  return std::log(miss_probability) / std::log1p(-both_inliers);
}

/// The line through two of the points that has the most of them near it.
std::optional<Line> most_supported_line(const PointSet& points, const LineFitOptions& options,
                                        Random& random) {
  std::optional<Line> best;
  std::size_t best_inliers = 0;
  double needed = options.max_draws;
  for (int draw = 0; draw < options.max_draws && draw < needed; ++draw) {
    const std::size_t i = random.index(points.size()), j = random.index(points.size());
    const std::optional<Line> line = line_through(points[i], points[j]);
    if (!line) continue;
    const auto inliers =
        static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
          return line->distance_m(p) <= options.inlier_distance_m;
        }));
    if (inliers <= best_inliers) continue;
    best = line;
    best_inliers = inliers;
    needed = draws_needed(static_cast<double>(inliers) / static_cast<double>(points.size()),
                          options.miss_probability);
  }
  return best;
}

/// The line with the least sum of squared distances from the points, and its figures. Expects two points or
/// more.
LineFit total_least_squares(const PointSet& points) {
  const auto n = static_cast<double>(points.size());
  LineFit fit;
  for (const Eigen::Vector2d& p : points) fit.center_m += p / n;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) scatter += (p - fit.center_m) * (p - fit.center_m).transpose();
  fit.angle_rad = 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));

  const Eigen::Vector2d along(std::cos(fit.angle_rad), std::sin(fit.angle_rad));
  double first_m = std::numeric_limits<double>::infinity(), last_m = -first_m, along_squared = 0,
         across_squared = 0;
  for (const Eigen::Vector2d& p : points) {
    const double s = along.dot(p - fit.center_m);
    first_m = std::min(first_m, s), last_m = std::max(last_m, s);
    along_squared += s * s;
    across_squared += (p - fit.center_m).squaredNorm() - s * s;
  }
  fit.inliers = points.size();
  fit.length_m = last_m - first_m;
  fit.residual_rms_m = std::sqrt(std::max(0.0, across_squared) / n);
  fit.angle_sigma_rad = along_squared > 0 ? fit.residual_rms_m / std::sqrt(along_squared) : kPi;
  return fit;
}

Line as_line(const LineFit& fit) {
  const Eigen::Vector2d normal(-std::sin(fit.angle_rad), std::cos(fit.angle_rad));
  return {normal, normal.dot(fit.center_m)};
}

}  // namespace

double LineFit::distance_m(const Eigen::Vector2d& point_m) const {
  return as_line(*this).distance_m(point_m);
}

std::optional<LineFit> fit_line(const PointSet& points_m, const LineFitOptions& options, Random& random) {
  const PointSet points = thinned(points_m, options.spacing_m);
  if (points.size() < std::max<std::size_t>(2, options.min_inliers)) return std::nullopt;
  const std::optional<Line> drawn = most_supported_line(points, options, random);
  if (!drawn) return std::nullopt;

  // The fitted line gathers inliers of its own; a few rounds settle it.
  constexpr int kRounds = 10;
  PointSet inliers = inliers_of(*drawn, points, options.inlier_distance_m);
  LineFit fit = total_least_squares(inliers);
  for (int round = 0; round < kRounds; ++round) {
    PointSet again = inliers_of(as_line(fit), points, options.inlier_distance_m);
    if (again.size() <= inliers.size()) break;
    inliers = std::move(again);
    fit = total_least_squares(inliers);
  }
  fit.inlier_share = static_cast<double>(fit.inliers) / static_cast<double>(points.size());
  if (fit.inliers < options.min_inliers || fit.length_m < options.min_length_m) return std::nullopt;
  return fit;
}

double turn_parallel_to(const LineFit& line_in_base) { return line_in_base.angle_rad; }

double turn_square_to(const LineFit& line_in_base) {
  const double turn = std::remainder(line_in_base.angle_rad, kPi / 2);
  return turn <= -kPi / 4 ? kPi / 4 : turn;
}

}  // namespace mstsl
