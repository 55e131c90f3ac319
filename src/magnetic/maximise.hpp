#pragma once

#include <functional>

#include <Eigen/Core>

namespace mstsl {

/// A value and its gradient, to be made as large as possible.
struct Objective {
  double value = 0.0;
  Eigen::VectorXd gradient;
};

struct Maximum {
  Eigen::VectorXd at;
  double value = 0.0;
};

/// A local maximum of a smooth function within the box low .. high, from `start` inside it (quasi-Newton,
/// Ceres). The function may return a value that is not finite where it cannot be evaluated.
Maximum maximise(const std::function<Objective(const Eigen::VectorXd&)>& function,
                 const Eigen::VectorXd& start, const Eigen::VectorXd& low, const Eigen::VectorXd& high);

}  // namespace mstsl
