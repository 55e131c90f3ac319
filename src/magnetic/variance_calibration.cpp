#include "mstsl/magnetic/variance_calibration.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace mstsl {
namespace {

using Eigen::Array3d;
using Eigen::Matrix4d;
using Eigen::Vector4d;

constexpr double kFreedom = 4.0;  // as joint::Surprise has it
/// Square of the distance, in scales of Student's t with 4 degrees of freedom, within which 68.3 % lie.
constexpr double kScalesOfOneSigma2 = 1.31;
constexpr double kLeastStrength = 1e-3,
                 kMostStrength = 1e3;  // of the field's variance: beyond, take it as this
constexpr double kLeastVariance_uT2 = 1e-6;

/// Log of the density of an error of that variance, and its derivative by the variance's log.
struct Density {
  double log, by_log_variance;
};
Density density(double error, double variance, Tails tails) {
  if (tails == Tails::kNone) {
    const double squared = error * error / variance;
    return {-0.5 * (std::log(variance) + squared), -0.5 + 0.5 * squared};
  }
  const double scale2 = variance / kScalesOfOneSigma2, squared = error * error / scale2;
  const double log = -0.5 * std::log(scale2) - 0.5 * (kFreedom + 1) * std::log1p(squared / kFreedom);
  return {log, -0.5 + 0.5 * (kFreedom + 1) * squared / (kFreedom + squared)};
}
/// Fisher information on the variance's log in one error.
double information(Tails tails) { return tails == Tails::kNone ? 0.5 : 0.5 * kFreedom / (kFreedom + 3.0); }

/// Of one component: logs of the factor and of both readings' variances, and the power.
struct OneComponent {
  double prior_uT2;
  Tails tails;

  enum : int { kFactor, kEven, kUneven, kPower };

  struct Variance {
    double value;
    Vector4d slope;
  };
  Variance of(const Vector4d& at, double variance_uT2, double strength) const {
    const double log_strength = std::log(std::clamp(strength, kLeastStrength, kMostStrength));
    const double b = std::exp(at(kPower) * log_strength), factor = std::exp(at(kFactor)) * std::min(b, 1.0);
    const double share = variance_uT2 / prior_uT2, below = 1.0 + (factor - 1.0) * share;
    const double from_map = std::max(b, 1.0) * factor * variance_uT2 / below;
    const double by_factor = from_map * std::max(0.0, 1.0 - share) / below;
    const double even = std::exp(at(kEven)), uneven = std::exp(at(kUneven)) * b;
    const double by_log_b = (b > 1.0 ? from_map : by_factor) + uneven;
    return {from_map + even + uneven, {by_factor, even, uneven, by_log_b * log_strength}};
  }

  /// Log of the posterior with its slope and Fisher information.
  struct Posterior {
    double log = 0.0;
    Vector4d slope = Vector4d::Zero();
    Matrix4d information = Matrix4d::Zero();
  };
  Posterior posterior(const Vector4d& at, const Vector4d& expected, std::span<const HeldOutError> errors,
                      int c) const {
    // Priors worth a few errors, so that few errors do not run away.
    const Vector4d precision(3.0, 1.0, 1.0, 1.0), off = at - expected;
    Posterior sum{-0.5 * off.dot(precision.cwiseProduct(off)), -precision.cwiseProduct(off),
                  precision.asDiagonal()};
    for (const HeldOutError& e : errors) {
      const Variance variance = of(at, e.variance_uT2(c), e.strength);
      const Density d = density(e.error_uT(c), variance.value, tails);
      const Vector4d by_log = variance.slope / variance.value;
      sum.log += d.log;
      sum.slope += d.by_log_variance * by_log;
      sum.information += information(tails) * by_log * by_log.transpose();
    }
    return sum;
  }

  /// Fisher scoring; a step that makes it worse is halved.
  Vector4d fit(const Vector4d& expected, std::span<const HeldOutError> errors, int c) const {
    constexpr int kIterations = 60, kHalvings = 8;
    constexpr double kMostPower = 3.0, kConverged = 1e-6;
    Vector4d at = expected + Vector4d(0, 0, 0, 0.5);
    Posterior here = posterior(at, expected, errors, c);
    for (int i = 0; i < kIterations; ++i) {
      Vector4d step = here.information.ldlt().solve(here.slope);
      step /= std::max(1.0, step.cwiseAbs().maxCoeff());
      bool better = false;
      for (int k = 0; k < kHalvings && !better; ++k, step *= 0.5) {
        Vector4d there = at + step;
        there(kPower) = std::clamp(there(kPower), 0.0, kMostPower);
        const Posterior next = posterior(there, expected, errors, c);
        better = next.log > here.log;
        if (better) at = there, here = next;
      }
      if (!better || step.cwiseAbs().maxCoeff() < kConverged) break;
    }
    return at;
  }
};

double log_variance(double sd_uT) { return std::log(std::max(sd_uT * sd_uT, kLeastVariance_uT2)); }

}  // namespace

Array3d VarianceCalibration::reading_variance_uT2(double strength) const {
  return apply(Array3d::Zero(), strength);
}

Array3d VarianceCalibration::apply(const Array3d& variance_uT2, double strength) const {
  Array3d result;
  for (int c = 0; c < 3; ++c) result(c) = apply(c, variance_uT2(c), strength);
  return result;
}

double VarianceCalibration::apply(int c, double variance_uT2, double strength) const {
  const double b = std::pow(std::clamp(strength, kLeastStrength, kMostStrength), power(c));
  const double f = factor(c) * std::min(b, 1.0), share = variance_uT2 / (prior_sd_uT(c) * prior_sd_uT(c));
  const double of_map = std::max(b, 1.0) * f * variance_uT2 / (1.0 + (f - 1.0) * share);
  return of_map + even_sd_uT(c) * even_sd_uT(c) + b * uneven_sd_uT(c) * uneven_sd_uT(c);
}

VarianceCalibration calibrate(std::span<const HeldOutError> errors, const VarianceCalibration& prior,
                              Tails tails) {
  VarianceCalibration calibration = prior;
  if (errors.empty()) return calibration;
  for (int c = 0; c < 3; ++c) {
    const OneComponent one{prior.prior_sd_uT(c) * prior.prior_sd_uT(c), tails};
    const Vector4d at = one.fit({std::log(prior.factor(c)), log_variance(prior.even_sd_uT(c)),
                                 log_variance(prior.uneven_sd_uT(c)), prior.power(c)},
                                errors, c);
    calibration.factor(c) = std::exp(at(OneComponent::kFactor));
    calibration.even_sd_uT(c) = std::exp(0.5 * at(OneComponent::kEven));
    calibration.uneven_sd_uT(c) = std::exp(0.5 * at(OneComponent::kUneven));
    calibration.power(c) = at(OneComponent::kPower);
  }
  return calibration;
}

VarianceCalibration uncalibrated(const Array3d& noise_sd_uT, const Array3d& prior_sd_uT) {
  VarianceCalibration own;
  own.even_sd_uT = own.uneven_sd_uT = std::sqrt(0.5) * noise_sd_uT;
  own.prior_sd_uT = prior_sd_uT;
  return own;
}

double mean_log_density(std::span<const HeldOutError> errors, const VarianceCalibration& calibration) {
  double sum = 0.0;
  for (const HeldOutError& e : errors) {
    const Array3d variance = calibration.apply(e.variance_uT2, e.strength);
    for (int c = 0; c < 3; ++c) sum += density(e.error_uT(c), variance(c), Tails::kHeavy).log;
  }
  return errors.empty() ? 0.0 : sum / static_cast<double>(errors.size());
}

HeldOutScore score(std::span<const HeldOutError> errors, const VarianceCalibration& calibration) {
  HeldOutScore score;
  score.errors = errors.size();
  if (errors.empty()) return score;
  const double share = 1.0 / static_cast<double>(errors.size());
  for (const HeldOutError& e : errors) {
    const Array3d sigmas = e.error_uT.abs() / calibration.apply(e.variance_uT2, e.strength).max(1e-30).sqrt();
    score.rms_uT += share * e.error_uT.square();
    score.within_1_sigma += share * (sigmas <= 1.0).cast<double>();
    score.within_2_sigma += share * (sigmas <= 2.0).cast<double>();
  }
  score.rms_uT = score.rms_uT.sqrt();
  return score;
}

}  // namespace mstsl
