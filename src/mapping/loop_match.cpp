#include "loop_match.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace mstsl {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

}  // namespace

Matrix3d least_covariance() { return Vector3d(9e-4, 9e-4, 3.6e-5).asDiagonal(); }

std::vector<LoopMatch> loop_matches(const SubmapWalls& walls, const Stretch& stretch, const PosePrior& prior,
                                    const LoopCloserOptions& options) {
  std::vector<LoopMatch> matches;
  if (!walls.cells) return matches;
  SearchWindow window =
      SearchWindow::around(prior.mean, prior.covariance, options.sigmas, walls.cells->occupancy.geometry());
  window.reach_m = window.reach_m.cwiseMin(options.widest_m);
  window.reach_rad = std::min(window.reach_rad, options.widest_rad);
  const PoseSearchOptions search{
      .min_score = options.min_score, .distinct_m = 0.5, .distinct_rad = 0.15, .max_answers = 12};
  const PointSet points = at_most(stretch.points_m, 300);
  const Matrix3d prior_information = prior.covariance.inverse();
  for (const ScoredPose& found : search_poses(walls.cells->pyramid, points, window, search)) {
    const PosePrior around = PosePrior::isotropic(found.map_T_base, 0.15, 0.05);
    const WallFit fit = fit_to_walls(walls.walls, points, around, {.sigma_m = 0.1, .max_iterations = 10});
    if (fit.score < options.min_score) continue;
    const bool known = std::any_of(matches.begin(), matches.end(), [&](const LoopMatch& m) {
      return distance(m.origin_T_base, fit.map_T_base) < 0.3 &&
             std::abs(angle_between(m.origin_T_base.yaw, fit.map_T_base.yaw)) < 0.1;
    });
    if (known) continue;
    LoopMatch match{fit.map_T_base, {}, fit.score, 0.0, 0.0};
    // Along what the scans leave open it is known as well as the graph had it.
    match.covariance = (fit.information + prior_information).inverse() + least_covariance();
    const Vector3d e = difference(prior.mean, fit.map_T_base);
    match.log_prior = -0.5 * e.dot(prior_information * e);
    matches.push_back(match);
  }
  return matches;
}

void add_along_what_scans_leave_open(const SubmapWalls& walls, const Stretch& stretch, const PosePrior& prior,
                                     std::vector<LoopMatch>& matches) {
  constexpr double kOpen_m = 0.12, kStep_m = 0.1;
  const Matrix3d prior_information = prior.covariance.inverse();
  std::vector<LoopMatch> more;
  for (const LoopMatch& match : matches) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(match.covariance.topLeftCorner<2, 2>());
    const double sd_m = std::sqrt(eigen.eigenvalues().y());
    if (sd_m < kOpen_m) continue;
    const Eigen::Vector2d along = eigen.eigenvectors().col(1);
    const int steps = static_cast<int>(std::min(3.0 * sd_m, 6.0) / kStep_m);
    for (int i = -steps; i <= steps; ++i) {
      LoopMatch shifted = match;
      shifted.origin_T_base =
          Pose2::from(match.origin_T_base.position() + i * kStep_m * along, match.origin_T_base.yaw);
      shifted.score = wall_score(walls.walls, at_most(stretch.points_m, 300), shifted.origin_T_base, 0.1);
      const Vector3d e = difference(prior.mean, shifted.origin_T_base);
      shifted.log_prior = -0.5 * e.dot(prior_information * e);
      Matrix3d narrow = Matrix3d::Zero();
      narrow.topLeftCorner<2, 2>() = along * along.transpose() / (kStep_m * kStep_m);
      shifted.covariance = (match.covariance.inverse() + narrow).inverse();
      more.push_back(shifted);
    }
  }
  for (LoopMatch& m : more) matches.push_back(m);
}

}  // namespace mstsl
