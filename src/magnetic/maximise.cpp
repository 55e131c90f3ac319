#include "maximise.hpp"

#include <cmath>

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

namespace mstsl {
namespace {

using Eigen::ArrayXd;
using Eigen::VectorXd;

/// The box is reached through x = low + (high - low) / (1 + exp(-u)), so that the solver needs no bounds.
struct Box {
  ArrayXd low, width;

  ArrayXd inside(const ArrayXd& u) const { return low + width / (1.0 + (-u).exp()); }
  ArrayXd slope(const ArrayXd& u) const {
    const ArrayXd s = 1.0 / (1.0 + (-u).exp());
    return width * s * (1.0 - s);
  }
  ArrayXd outside(const ArrayXd& x) const {
    const ArrayXd share = ((x - low) / width).max(1e-3).min(1.0 - 1e-3);
    return (share / (1.0 - share)).log();
  }
};

class Negated final : public ceres::FirstOrderFunction {
 public:
  Negated(const std::function<Objective(const VectorXd&)>& function, const Box& box)
      : function_(function), box_(box) {}

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const ArrayXd u = Eigen::Map<const ArrayXd>(parameters, box_.low.size());
    const Objective objective = function_(box_.inside(u).matrix());
    if (!std::isfinite(objective.value)) return false;
    *cost = -objective.value;
    if (gradient != nullptr)
      Eigen::Map<ArrayXd>(gradient, box_.low.size()) = -objective.gradient.array() * box_.slope(u);
    return true;
  }
  int NumParameters() const override { return static_cast<int>(box_.low.size()); }

 private:
  const std::function<Objective(const VectorXd&)>& function_;
  Box box_;
};

}  // namespace

Maximum maximise(const std::function<Objective(const VectorXd&)>& function, const VectorXd& start,
                 const VectorXd& low, const VectorXd& high) {
  const Box box{low, high - low};
  ArrayXd u = box.outside(start);
  ceres::GradientProblemSolver::Options options;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 30;  // two or three parameters: it takes about ten
  options.function_tolerance = 1e-5;
  ceres::GradientProblemSolver::Summary summary;
  const ceres::GradientProblem problem(new Negated(function, box));
  ceres::Solve(options, problem, u.data(), &summary);
  return {box.inside(u).matrix(), -summary.final_cost};
}

}  // namespace mstsl
