#include "mstsl/scan/refine.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

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
    Slope sum;
    for_each(change, [&](std::size_t, const Slope& point) {
      sum.value += point.value;
      sum.by_change += point.by_change;
    });
    return sum;
  }

  /// The second derivatives of each point's part in that sum, from its slopes half a sigma of the field to
  /// each side: along the base's own axes, so that they do not depend on how the map lies.
  std::vector<Eigen::Matrix3d> curvatures(const Eigen::Vector3d& change) const {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    axes.topLeftCorner<2, 2>() = pose(change).rotation();
    const Eigen::Vector3d steps = 0.5 * units();
    std::vector<Eigen::Matrix3d> curvatures(points_.size(), Eigen::Matrix3d::Zero());
    for (int k = 0; k < 3; ++k) {
      for (const double side : {-1.0, 1.0}) {
        for_each(change + side * steps(k) * axes.col(k), [&](std::size_t i, const Slope& point) {
          curvatures[i].col(k) += side / (2 * steps(k)) * point.by_change;
        });
      }
    }
    for (Eigen::Matrix3d& c : curvatures) {
      const Eigen::Matrix3d by_map_axes = c * axes.transpose();
      c = 0.5 * (by_map_axes + by_map_axes.transpose());
    }
    return curvatures;
  }

  /// Changes of x, y and yaw that move the points by about a sigma of the field.
  Eigen::Vector3d units() const { return Eigen::Vector3d(1, 1, 1 / arm_m()) * field_.sigma_m(); }

 private:
  /// The typical distance of the points from the base: how far a turn moves them. Never nothing.
  double arm_m() const {
    double squares = field_.sigma_m() * field_.sigma_m();
    for (const Eigen::Vector2d& p : points_) squares += p.squaredNorm() / static_cast<double>(points_.size());
    return std::sqrt(squares);
  }

  /// Calls `use(i, slope of 1 - likelihood)` for each point.
  template <typename Use>
  void for_each(const Eigen::Vector3d& change, Use use) const {
    const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(initial_.yaw + change.z()).toRotationMatrix();
    const Eigen::Vector2d position = initial_.position() + change.head<2>();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector2d arm = rotation * points_[i];
      const LikelihoodField::Sample sample = field_.sample(field_.frame().to_grid(arm + position));
      const Eigen::Vector2d by_place = field_.frame().slope_to_map(sample.gradient_per_cell);
      const double by_yaw = arm.x() * by_place.y() - arm.y() * by_place.x();
      use(i, Slope{1.0 - sample.value, -Eigen::Vector3d(by_place.x(), by_place.y(), by_yaw)});
    }
  }

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
    const Eigen::Vector3d off = difference(mean_, pose);
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

/// What the points surely say of the pose: the sum of their curvatures, in each of its own directions less
/// two standard errors, and nothing where that leaves nothing. Walls that run askew through the cells are
/// drawn as stairs; along a bare corridor the points' curvatures on them are as often up as down and add up
/// to little, but seldom to zero.
Eigen::Matrix3d sure_information(const ScanCost& scan, const Eigen::Vector3d& change) {
  constexpr double kStandardErrors = 2.0;
  const std::vector<Eigen::Matrix3d> curvatures = scan.curvatures(change);
  // In units in which a turn and a shift compare.
  const Eigen::DiagonalMatrix<double, 3> units(scan.units());
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& c : curvatures) sum += units * c * units;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
  Eigen::Vector3d sure;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = units * eigen.eigenvectors().col(k);
    double squares = 0;
    for (const Eigen::Matrix3d& c : curvatures) squares += std::pow(direction.dot(c * direction), 2);
    sure(k) = std::max(0.0, eigen.eigenvalues()(k) - kStandardErrors * std::sqrt(squares));
  }
  const Eigen::Matrix3d directions = units.inverse() * eigen.eigenvectors();
  return directions * sure.asDiagonal() * directions.transpose();
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
  const Eigen::Vector3d units = scan.units();
  const ceres::GradientProblem problem(
      new NegativeLogPosterior(scan, prior, options.points_per_error, units));
  ceres::GradientProblemSolver::Summary summary;
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();
  ceres::Solve(solver_options(options), problem, parameters.data(), &summary);

  const Eigen::Vector3d change = units.cwiseProduct(parameters);
  Refinement refined;
  refined.map_T_base = scan.pose(change);
  // Interpolation may overshoot the top of a wall a little.
  refined.cost = std::max(0.0, scan.at(change).value / static_cast<double>(points_base_m.size()));
  refined.information = sure_information(scan, change) / options.points_per_error;
  refined.covariance = (refined.information + prior.covariance.inverse()).inverse();
  refined.converged = summary.termination_type == ceres::CONVERGENCE;
  return refined;
}

}  // namespace mstsl
