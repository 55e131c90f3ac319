#pragma once

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/scan/likelihood_field.hpp"
#include "mstsl/scan/points.hpp"

namespace mstsl {

/// What is believed of a pose before the scan is looked at: a Gaussian over (x, y, yaw) in the map frame.
struct PosePrior {
  Pose2 mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();

  /// Equal standard deviations for both coordinates, none of them correlated.
  static PosePrior isotropic(const Pose2& mean, double sigma_m, double sigma_rad);
};

struct RefineOptions {
  int max_iterations = 20;
  /// Only every n-th point brings independent evidence: neighbours on one wall share the map's errors. The
  /// scan's information is divided by this; with points 0.1 m apart, 5 stands for one independent error every
  /// half metre. With it the errors in four real buildings are a little smaller than claimed (mean of e' C^-1
  /// e: 0.4 to 1.1, of 3).
  double points_per_error = 5.0;
};

struct Refinement {
  Pose2 map_T_base;
  double cost = 0.0;                                     ///< mean of 1 - likelihood over the points, 0 .. 1
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of scan and prior together
  /// Of the scan alone (inverse covariance), and only what it surely says: singular where the scan does not
  /// fix the pose, as along a bare corridor.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  bool converged = false;  ///< false: stopped by max_iterations, or there was nothing to fit
};

/// The pose near `initial` that fits the points to the map best, with the prior: the least-squares scan
/// matcher of the paper (Sec. III-B, Ceres) on a bicubic likelihood field (after Hess et al. 2016, Eq. CS).
/// With no points the answer is the prior. Expects finite poses and a positive definite prior covariance.
Refinement refine_pose(const LikelihoodField& field, const PointSet& points_base_m, const Pose2& initial,
                       const PosePrior& prior, const RefineOptions& options = {});

}  // namespace mstsl
