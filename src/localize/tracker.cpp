#include "mstsl/localize/tracker.hpp"

#include <utility>

#include <Eigen/Eigenvalues>

namespace mstsl {
namespace {

Eigen::Matrix3d diagonal(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

}  // namespace

Tracker::Tracker(std::shared_ptr<const LocalizationMaps> maps, const Pose2& map_T_base,
                 const Eigen::Matrix3d& covariance, const TrackerOptions& options)
    : maps_(std::move(maps)), options_(options), map_T_base_(map_T_base), covariance_(covariance) {}

void Tracker::observe(const PointSet& points_base_m, const Pose2& last_T_base, bool broken) {
  covariance_ = moved_covariance(map_T_base_, covariance_, last_T_base, options_.odometry) +
                diagonal(options_.sigma_floor_m, options_.sigma_floor_rad);
  map_T_base_ = map_T_base_ * last_T_base;
  if (points_base_m.empty()) return;
  if (broken) {
    covariance_ += diagonal(options_.search_sigma_m, options_.search_sigma_rad);
    search(points_base_m);
  } else {
    refine(points_base_m);
  }
  low_scans_ = score_ < options_.low_score ? low_scans_ + 1 : 0;
  if (low_scans_ > 0 && low_scans_ % options_.low_scans_to_search == 0) search(points_base_m);
}

bool Tracker::lost(bool other_witness_agrees) const {
  const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance_.topLeftCorner<2, 2>(),
                                                                        Eigen::EigenvaluesOnly)
                             .eigenvalues()
                             .maxCoeff();
  return (low_scans_ >= options_.low_scans_to_lose && !other_witness_agrees) ||
         !(largest <= options_.max_sigma_m * options_.max_sigma_m);
}

void Tracker::refine(const PointSet& points_base_m) {
  const PointSet few = at_most(thinned(points_base_m, options_.spacing_m), options_.max_points);
  const Refinement refined =
      refine_pose(maps_->walls->field, few, map_T_base_, {map_T_base_, covariance_}, options_.refine);
  if (refined.map_T_base.is_finite() && refined.covariance.allFinite()) {
    map_T_base_ = refined.map_T_base;
    covariance_ = refined.covariance;
  }
  score_ = confidence_score(maps_->occupancy, points_base_m, map_T_base_, options_.score);
}

/// Looks around for a pose that explains the scan, and takes it only if it does so as well as an answer must.
void Tracker::search(const PointSet& points_base_m) {
  const PosePrior around{map_T_base_,
                         covariance_ + diagonal(options_.search_sigma_m, options_.search_sigma_rad)};
  const PointSet few = at_most(thinned(points_base_m, options_.spacing_m), options_.max_points);
  const auto found = match_submap(*maps_->walls, few, points_base_m, around, options_.search);
  const double here = confidence_score(maps_->occupancy, points_base_m, map_T_base_, options_.score);
  score_ = here;
  if (!found || found->confidence <= here || found->confidence < options_.min_found_score) return;
  map_T_base_ = found->refined.map_T_base;
  covariance_ = found->refined.covariance;
  score_ = found->confidence;
}

}  // namespace mstsl
