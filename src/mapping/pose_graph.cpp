#include "mstsl/mapping/pose_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <ceres/ceres.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Parameters = std::array<double, 3>;

/// S with S^T S = information, which may be singular.
Matrix3d root_of(const Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(0.5 * (information + information.transpose()));
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

template <typename T>
T wrapped(const T& angle) {
  return angle - T(2 * kPi) * ceres::floor((angle + T(kPi)) / T(2 * kPi));
}

/// The motion from one pose to the other against a measured one.
template <typename T>
Eigen::Matrix<T, 3, 1> off(const T* a, const T* b, const T& x, const T& y, const T& yaw) {
  const T c = ceres::cos(a[2]), s = ceres::sin(a[2]), dx = b[0] - a[0], dy = b[1] - a[1];
  return {c * dx + s * dy - x, -s * dx + c * dy - y, wrapped(T(b[2] - a[2] - yaw))};
}

struct MotionResidual {
  Pose2 motion;
  Matrix3d root;

  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    Eigen::Map<Eigen::Matrix<T, 3, 1>> r(residual);
    r = root.cast<T>() * off(a, b, T(motion.x), T(motion.y), T(motion.yaw));
    return true;
  }
};

/// The same for the wheels, whose calibration is sought too; as WheelCalibration::corrected().
struct WheelResidual {
  Pose2 motion;
  Matrix3d root;

  template <typename T>
  bool operator()(const T* a, const T* b, const T* wheels, T* residual) const {
    Eigen::Map<Eigen::Matrix<T, 3, 1>> r(residual);
    const T scale = T(1) + wheels[0];
    const T yaw = (T(1) + wheels[2]) * motion.yaw + wheels[1] * motion.x;
    r = root.cast<T>() * off(a, b, T(scale * motion.x), T(scale * motion.y), yaw);
    return true;
  }
};

struct WheelPrior {
  WheelCalibration sd;

  template <typename T>
  bool operator()(const T* wheels, T* residual) const {
    residual[0] = wheels[0] / sd.scale;
    residual[1] = wheels[1] / sd.drift_rad_per_m;
    residual[2] = wheels[2] / sd.turn_scale;
    return true;
  }
};

Parameters parameters_of(const Pose2& pose) { return {pose.x, pose.y, pose.yaw}; }

/// Of the inverse motion, in the axes of its start.
Matrix3d of_inverse(const Pose2& a_T_b, const Matrix3d& covariance) {
  const Eigen::Matrix2d b_R_a = a_T_b.rotation().transpose();
  const Eigen::Vector2d b_a = inverse(a_T_b).position();
  Matrix3d j = Matrix3d::Zero();
  j.topLeftCorner<2, 2>() = -b_R_a;
  j.topRightCorner<2, 1>() = Eigen::Vector2d(b_a.y(), -b_a.x());
  j(2, 2) = -1.0;
  return j * covariance * j.transpose();
}

/// Of a_T_b * b_T_c, in the axes of a.
Matrix3d composed(const Pose2& a_T_b, const Matrix3d& to_b, const Pose2& b_T_c, const Matrix3d& b_to_c) {
  Matrix3d by_first = Matrix3d::Identity(), by_second = Matrix3d::Identity();
  const Eigen::Vector2d arm = a_T_b.rotation() * b_T_c.position();
  by_first(0, 2) = -arm.y(), by_first(1, 2) = arm.x();
  by_second.topLeftCorner<2, 2>() = a_T_b.rotation();
  return by_first * to_b * by_first.transpose() + by_second * b_to_c * by_second.transpose();
}

/// 10 m and a half turn: what an information without anything in it stands for.
Matrix3d covariance_of(const Matrix3d& information) {
  const Eigen::Vector3d least(0.01, 0.01, 0.1);
  return (information + Matrix3d(least.asDiagonal())).inverse();
}

}  // namespace

void PoseGraph::add(const ChainLink& link) {
  if (poses_.empty()) {
    poses_.push_back({});
  } else {
    poses_.push_back(poses_.back() * link.by_scans);
  }
  links_.push_back(link);
  link_covariances_.push_back(covariance_of(link.wheels_information + link.scans_information));
  closures_at_.emplace_back();
}

void PoseGraph::add(const Closure& closure) {
  for (const std::size_t end : {closure.from, closure.to}) closures_at_[end].push_back(closures_.size());
  closures_.push_back(closure);
  closure_covariances_.push_back(covariance_of(closure.information));
}

void PoseGraph::move_tail(std::size_t first, std::size_t i, const Pose2& to) {
  const Pose2 by = to * inverse(poses_[i]);
  for (std::size_t k = first; k < poses_.size(); ++k) poses_[k] = by * poses_[k];
}

void PoseGraph::optimise() {
  if (poses_.size() < 2) return;
  solve();
  for (int i = 0; i < 5 && refute(); ++i) solve();
}

void PoseGraph::solve() {
  std::vector<Parameters> poses;
  poses.reserve(poses_.size());
  for (const Pose2& pose : poses_) poses.push_back(parameters_of(pose));
  Parameters wheels{wheels_.scale, wheels_.drift_rad_per_m, wheels_.turn_scale};
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<WheelPrior, 3, 3>(new WheelPrior{options_.wheels_sd}), nullptr,
      wheels.data());
  const auto tie = [&](std::size_t a, std::size_t b, const Pose2& motion, const Matrix3d& information,
                       ceres::LossFunction* loss) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MotionResidual, 3, 3, 3>(
                                 new MotionResidual{motion, root_of(information)}),
                             loss, poses[a].data(), poses[b].data());
  };
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const ChainLink& link = links_[i];
    if (link.wheels_information.isZero()) continue;  // a new drive
    // Wheels slip and recordings have gaps: where wheels and scans contradict each other the wheels give in.
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<WheelResidual, 3, 3, 3, 3>(
                                 new WheelResidual{link.by_wheels, root_of(link.wheels_information)}),
                             new ceres::CauchyLoss(2.0), poses[i - 1].data(), poses[i].data(), wheels.data());
    if (!link.scans_information.isZero())
      tie(i - 1, i, link.by_scans, link.scans_information, new ceres::HuberLoss(4.0));
  }
  for (const Closure& c : closures_)
    if (!c.refuted) tie(c.from, c.to, c.from_T_to, c.information, new ceres::CauchyLoss(2.0));
  problem.SetParameterBlockConstant(poses.front().data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options_.max_iterations;
  solver.num_threads = 1;  // sums in one order: the same digits however many cores there are
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return;
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses_[i] = Pose2::from({poses[i][0], poses[i][1]}, poses[i][2]);
  wheels_ = {wheels[0], wheels[1], wheels[2]};
}

bool PoseGraph::refute() {
  bool any = false;
  const double limit = options_.refuted_beyond * options_.refuted_beyond;
  for (Closure& c : closures_) {
    if (c.refuted) continue;
    const Vector3d e = difference(c.from_T_to, between(poses_[c.from], poses_[c.to]));
    if (e.dot(c.information * e) > limit) c.refuted = any = true;
  }
  return any;
}

std::vector<PoseGraph::Edge> PoseGraph::edges_of(std::size_t i) const {
  std::vector<Edge> edges;
  const auto ahead = [&](std::size_t to, const Matrix3d& covariance) { edges.push_back({to, covariance}); };
  const auto back = [&](std::size_t from, const Matrix3d& covariance) {
    edges.push_back({from, of_inverse(between(poses_[from], poses_[i]), covariance)});
  };
  const auto is_joined = [&](std::size_t k) { return !links_[k].wheels_information.isZero(); };
  if (i > 0 && is_joined(i)) back(i - 1, link_covariances_[i]);
  if (i + 1 < poses_.size() && is_joined(i + 1)) ahead(i + 1, link_covariances_[i + 1]);
  for (const std::size_t k : closures_at_[i]) {
    const Closure& c = closures_[k];
    if (c.refuted) continue;
    if (c.from == i)
      ahead(c.to, closure_covariances_[k]);
    else
      back(c.from, closure_covariances_[k]);
  }
  return edges;
}

std::vector<Matrix3d> PoseGraph::covariances_from_last(std::span<const std::size_t> nodes) const {
  const Matrix3d unknown = Vector3d(1e4, 1e4, 10.0).asDiagonal();
  if (poses_.empty()) return {};
  std::vector<Matrix3d> covariances(poses_.size(), unknown);
  std::vector<bool> done(poses_.size(), false), wanted(poses_.size(), false);
  std::size_t left = 0;
  for (const std::size_t node : nodes)
    if (!wanted[node]) wanted[node] = true, ++left;
  using Candidate = std::pair<double, std::size_t>;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> open;
  std::vector<double> best(poses_.size(), std::numeric_limits<double>::infinity());
  open.push({0.0, poses_.size() - 1});
  best.back() = 0.0;
  covariances.back().setZero();
  const Pose2& last = poses_.back();
  while (!open.empty() && left > 0) {
    const std::size_t i = open.top().second;
    open.pop();
    if (done[i]) continue;
    done[i] = true;
    if (wanted[i]) --left;
    const Pose2 last_T_i = between(last, poses_[i]);
    for (const Edge& edge : edges_of(i)) {
      if (done[edge.to]) continue;
      const Matrix3d there =
          composed(last_T_i, covariances[i], between(poses_[i], poses_[edge.to]), edge.covariance);
      const double size = there.topLeftCorner<2, 2>().trace();
      if (size >= best[edge.to]) continue;
      best[edge.to] = size;
      covariances[edge.to] = there;
      open.push({size, edge.to});
    }
  }
  std::vector<Matrix3d> found;
  for (const std::size_t node : nodes) found.push_back(covariances[node]);
  return found;
}

}  // namespace mstsl
