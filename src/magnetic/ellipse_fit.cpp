#include "ellipse_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace mstsl {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

Index turn_of(const TurnSample& sample) { return static_cast<Index>(sample.turn); }

/// The mean over the samples of each turn; 0 for a turn without any.
template <typename Value>
VectorXd mean_by_turn(std::span<const TurnSample> samples, std::size_t turns, const Value& value) {
  VectorXd sum = VectorXd::Zero(static_cast<Index>(turns)), count = sum;
  for (const TurnSample& sample : samples) {
    sum(turn_of(sample)) += value(sample);
    count(turn_of(sample)) += 1.0;
  }
  return sum.cwiseQuotient(count.cwiseMax(1.0));
}

/// Huber's weights of residuals, full up to their median length.
VectorXd huber_weights(const VectorXd& residuals) {
  std::vector<double> sizes(residuals.size());
  VectorXd::Map(sizes.data(), residuals.size()) = residuals.cwiseAbs();
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double limit = std::max(2.0 * *middle, 1e-9);
  return residuals.cwiseAbs().unaryExpr([limit](double r) { return r <= limit ? 1.0 : limit / r; });
}

/// Solves x^2 + y^2 + p (x^2 - y^2) + 2 s x y - 2 u . (x, y) = c_turn, the residual divided by twice the
/// turn's radius, which makes it a distance.
class ConicSystem {
 public:
  ConicSystem(std::span<const TurnSample> samples, std::size_t turns)
      : samples_(samples), turns_(static_cast<Index>(turns)), weights_(VectorXd::Ones(rows())) {}

  void solve(const VectorXd& radii_uT) {
    MatrixXd a = MatrixXd::Zero(rows(), 4 + turns_);
    VectorXd b(rows());
    for (Index i = 0; i < rows(); ++i) {
      const TurnSample& sample = samples_[static_cast<std::size_t>(i)];
      const double x = sample.base_field_uT.x(), y = sample.base_field_uT.y();
      const double scale = 0.5 / std::max(radii_uT(turn_of(sample)), 1e-6);
      a.row(i).head<4>() = scale * Eigen::RowVector4d(x * x - y * y, 2 * x * y, -2 * x, -2 * y);
      a(i, 4 + turn_of(sample)) = -scale;
      b(i) = -scale * (x * x + y * y);
    }
    const MatrixXd normal = a.transpose() * weights_.asDiagonal() * a;
    // The unit of the columns differs by powers of the field; scaled, the matrix is well behaved.
    const VectorXd unit = normal.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
    const MatrixXd scaled = unit.asDiagonal() * normal * unit.asDiagonal();
    const VectorXd rhs = unit.asDiagonal() * (a.transpose() * weights_.asDiagonal() * b);
    solution_ = unit.asDiagonal() * Eigen::LDLT<MatrixXd>(scaled).solve(rhs);
    weights_ = huber_weights(a * solution_ - b);
  }

  /// Nothing if the conic is no ellipse, or one that no sensor would give (axes 1 : 3).
  std::optional<TurnEllipse> ellipse() const {
    constexpr double kMaxFlattening = 0.8;  // (1 - 1/9) / (1 + 1/9): axes of the squares 1 : 9
    if (!solution_.allFinite() || std::hypot(solution_(0), solution_(1)) > kMaxFlattening)
      return std::nullopt;
    Matrix2d q;
    q << 1 + solution_(0), solution_(1), solution_(1), 1 - solution_(0);
    TurnEllipse ellipse;
    ellipse.centre_uT = q.inverse() * solution_.segment<2>(2);
    ellipse.shape = Eigen::SelfAdjointEigenSolver<Matrix2d>(q / std::sqrt(q.determinant())).operatorSqrt();
    return ellipse;
  }

 private:
  Index rows() const { return static_cast<Index>(samples_.size()); }
  std::span<const TurnSample> samples_;
  Index turns_;
  VectorXd weights_, solution_;
};

/// How the vertical field follows the corrected horizontal one, apart from its own level at each turn.
Vector2d fit_lean(std::span<const TurnSample> samples, std::size_t turns, const TurnEllipse& ellipse) {
  const auto mean = [&](const auto& value) { return mean_by_turn(samples, turns, value); };
  const VectorXd z = mean([](const TurnSample& s) { return s.base_field_uT.z(); });
  const VectorXd x = mean([&](const TurnSample& s) { return ellipse.corrected(s.base_field_uT).x(); });
  const VectorXd y = mean([&](const TurnSample& s) { return ellipse.corrected(s.base_field_uT).y(); });
  Matrix2d normal = 1e-9 * Matrix2d::Identity();
  Vector2d rhs = Vector2d::Zero();
  for (const TurnSample& s : samples) {
    const Index t = turn_of(s);
    const Vector2d w = ellipse.corrected(s.base_field_uT) - Vector2d(x(t), y(t));
    normal += w * w.transpose();
    rhs += w * (s.base_field_uT.z() - z(t));
  }
  return normal.ldlt().solve(rhs);
}

}  // namespace

VectorXd strengths_uT(std::span<const TurnSample> samples, std::size_t turns, const TurnEllipse& ellipse) {
  return mean_by_turn(samples, turns,
                      [&](const TurnSample& s) { return ellipse.corrected(s.base_field_uT).norm(); });
}

double strength_change_uT(std::span<const TurnSample> samples, std::size_t turns,
                          const TurnEllipse& ellipse) {
  const VectorXd strengths = strengths_uT(samples, turns, ellipse);
  double sum = 0.0;
  for (const TurnSample& s : samples) {
    const double change = ellipse.corrected(s.base_field_uT).norm() - strengths(turn_of(s));
    sum += change * change / static_cast<double>(samples.size());
  }
  return std::sqrt(sum);
}

std::optional<TurnEllipse> fit_ellipse(std::span<const TurnSample> samples, std::size_t turns) {
  constexpr int kIterations = 8;
  if (samples.empty()) return std::nullopt;
  TurnEllipse ellipse;
  for (int c = 0; c < 2; ++c)
    ellipse.centre_uT(c) =
        mean_by_turn(samples, turns, [c](const TurnSample& s) { return s.base_field_uT(c); }).mean();
  ConicSystem system(samples, turns);
  for (int i = 0; i < kIterations; ++i) {
    system.solve(strengths_uT(samples, turns, ellipse));
    const auto better = system.ellipse();
    if (!better) return std::nullopt;
    ellipse = *better;
  }
  ellipse.lean = fit_lean(samples, turns, ellipse);
  return ellipse;
}

}  // namespace mstsl
