#include "mstsl/scan/refine.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// A value and its slope by a change (dx, dy in m, dyaw in rad) of the pose.
struct Slope {
  double value = 0.0;
  Eigen::Vector3d by_change = Eigen::Vector3d::Zero();
};

/// How ill the scan fits the map as its pose changes from `initial`.
class ScanCost {
 public:
  ScanCost(const LikelihoodField& field, const PointSet& points, const Pose2& initial)
      : field_(field), points_(points), initial_(initial) {}

  Pose2 pose(const Eigen::Vector3d& change) const {
    return Pose2::from(initial_.position() + change.head<2>(), initial_.yaw + change.z());
  }

  /// The sum of 1 - likelihood over the points.
  Slope at(const Eigen::Vector3d& change) const {
    const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(initial_.yaw + change.z()).toRotationMatrix();
    const Eigen::Vector2d position = initial_.position() + change.head<2>();
    Slope sum;
    for (const Eigen::Vector2d& point : points_) {
      const Eigen::Vector2d arm = rotation * point;
      const LikelihoodField::Sample sample = field_.sample(field_.frame().to_grid(arm + position));
      const Eigen::Vector2d by_place = field_.frame().slope_to_map(sample.gradient_per_cell);
      sum.value += 1.0 - sample.value;
      sum.by_change -=
          Eigen::Vector3d(by_place.x(), by_place.y(), arm.x() * by_place.y() - arm.y() * by_place.x());
    }
    return sum;
  }

  /// The sum's second derivatives, from slopes half a sigma of the field to each side. On walls that run
  /// askew through the cells the slopes' squares (Gauss and Newton's stand-in) would claim to know the way
  /// along a bare corridor to some centimetres; the curvatures of their little steps, up and down, cancel.
  Eigen::Matrix3d curvature(const Eigen::Vector3d& change) const {
    const double step_m = 0.5 * field_.sigma_m();
    const Eigen::Vector3d steps(step_m, step_m, step_m / arm_m());
    Eigen::Matrix3d curvature;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = steps(i) * Eigen::Vector3d::Unit(i);
      curvature.col(i) = (at(change + step).by_change - at(change - step).by_change) / (2 * steps(i));
    }
    return 0.5 * (curvature + curvature.transpose());
  }

  /// The typical distance of the points from the base: how far a turn moves them. Never nothing.
  double arm_m() const {
    double squares = field_.sigma_m() * field_.sigma_m();
    for (const Eigen::Vector2d& p : points_) squares += p.squaredNorm() / static_cast<double>(points_.size());
    return std::sqrt(squares);
  }

 private:
  const LikelihoodField& field_;
  const PointSet& points_;
  Pose2 initial_;
};

/// The negative log posterior for Ceres. Its variables are the change in units that move points by one sigma.
class NegativeLogPosterior final : public ceres::FirstOrderFunction {
 public:
  NegativeLogPosterior(const ScanCost& scan, const PosePrior& prior, double points_per_error,
                       const Eigen::Vector3d& units)
      : scan_(scan),
        mean_(prior.mean),
        information_(prior.covariance.inverse()),
        points_per_error_(points_per_error),
        units_(units) {}

  int NumParameters() const override { return 3; }

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const Eigen::Vector3d change = units_.cwiseProduct(Eigen::Map<const Eigen::Vector3d>(parameters));
    const Slope scan = scan_.at(change);
    const Pose2 pose = scan_.pose(change);
    const Eigen::Vector3d off(pose.x - mean_.x, pose.y - mean_.y, angle_between(mean_.yaw, pose.yaw));
    *cost = scan.value / points_per_error_ + 0.5 * off.dot(information_ * off);
    if (gradient != nullptr) {
      const Eigen::Vector3d slope = scan.by_change / points_per_error_ + information_ * off;
      Eigen::Map<Eigen::Vector3d>{gradient} = units_.cwiseProduct(slope);
    }
    return true;
  }

 private:
  const ScanCost& scan_;
  Pose2 mean_;
  Eigen::Matrix3d information_;
  double points_per_error_;
  Eigen::Vector3d units_;
};

ceres::GradientProblemSolver::Options solver_options(const RefineOptions& options) {
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = ceres::BFGS;
  solver.use_approximate_eigenvalue_bfgs_scaling = true;
  solver.max_num_iterations = options.max_iterations;
  // The cost is a negative log likelihood: where it changes by a ten thousandth of itself (some units, at
  // most tens) the pose stands within a few hundredths of its standard deviation.
  solver.function_tolerance = 1e-4;
  solver.parameter_tolerance = 1e-4;
  solver.gradient_tolerance = 1e-3;
  solver.logging_type = ceres::SILENT;
  return solver;
}

/// The nearest symmetric matrix without negative eigenvalues.
Eigen::Matrix3d without_negative_part(const Eigen::Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(symmetric);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace

PosePrior PosePrior::isotropic(const Pose2& mean, double sigma_m, double sigma_rad) {
  const Eigen::Vector3d variances(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  return {mean, variances.asDiagonal()};
}

Refinement refine_pose(const LikelihoodField& field, const PointSet& points_base_m, const Pose2& initial,
                       const PosePrior& prior, const RefineOptions& options) {
  if (points_base_m.empty()) return {.map_T_base = prior.mean, .cost = 1.0, .covariance = prior.covariance};
  const ScanCost scan(field, points_base_m, initial);
  const Eigen::Vector3d units = Eigen::Vector3d(1, 1, 1 / scan.arm_m()) * field.sigma_m();
  const ceres::GradientProblem problem(
      new NegativeLogPosterior(scan, prior, options.points_per_error, units));
  ceres::GradientProblemSolver::Summary summary;
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();
  ceres::Solve(solver_options(options), problem, parameters.data(), &summary);

  const Eigen::Vector3d change = units.cwiseProduct(parameters);
  Refinement refined;
  refined.map_T_base = scan.pose(change);
  refined.cost = scan.at(change).value / static_cast<double>(points_base_m.size());
  refined.information = without_negative_part(scan.curvature(change)) / options.points_per_error;
  refined.covariance = (refined.information + prior.covariance.inverse()).inverse();
  refined.converged = summary.termination_type == ceres::CONVERGENCE;
  return refined;
}

}  // namespace mstsl
