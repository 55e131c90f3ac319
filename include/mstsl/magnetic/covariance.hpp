#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <utility>

#include <Eigen/Core>

/// Covariance functions of a stationary field in the plane. They are small values that compose with + and *:
///   const auto k = SquaredExponential{7.0, 0.8} + WhiteNoise{0.5};
/// Parameters are positive and learned by their natural logs. Formulas: Rasmussen & Williams, chapter 4.
namespace mstsl {

/// How two samples lie to each other. A sample shares its noise with itself only, not with one at the same
/// point.
struct Lag {
  Eigen::Vector2d difference_m = Eigen::Vector2d::Zero();
  bool same_sample = false;
};

struct CovarianceParameter {
  std::string_view name;
  std::string_view unit;
  double value = 0.0;
};

/// A covariance and its derivative by the natural log of each parameter.
template <std::size_t N>
struct CovarianceValue {
  double value = 0.0;
  std::array<double, N> by_log_parameter{};
};

template <typename K>
concept CovarianceFunction = requires(const K k, const Lag& lag, const std::array<double, K::kSize>& logs) {
  { k(lag) } -> std::same_as<double>;
  { k.with_gradient(lag) } -> std::same_as<CovarianceValue<K::kSize>>;
  { k.parameters() } -> std::same_as<std::array<CovarianceParameter, K::kSize>>;
  { K::from_logs(logs) } -> std::same_as<K>;
};

/// sd^2 everywhere: a common offset of unknown size.
struct Constant {
  static constexpr std::size_t kSize = 1;
  double sd = 1.0;

  double operator()(const Lag&) const { return sd * sd; }
  CovarianceValue<1> with_gradient(const Lag&) const { return {sd * sd, {2 * sd * sd}}; }
  std::array<CovarianceParameter, 1> parameters() const { return {{{"constant_sd", "uT", sd}}}; }
  static Constant from_logs(const std::array<double, 1>& logs) { return {std::exp(logs[0])}; }
};

/// sd^2 for a sample with itself, nothing between two: what a second reading at the same point would not
/// repeat.
struct WhiteNoise {
  static constexpr std::size_t kSize = 1;
  double sd = 1.0;

  double operator()(const Lag& lag) const { return lag.same_sample ? sd * sd : 0.0; }
  CovarianceValue<1> with_gradient(const Lag& lag) const { return {(*this)(lag), {2 * (*this)(lag)}}; }
  std::array<CovarianceParameter, 1> parameters() const { return {{{"noise_sd", "uT", sd}}}; }
  static WhiteNoise from_logs(const std::array<double, 1>& logs) { return {std::exp(logs[0])}; }
};

/// Squared exponential, "the Gaussian kernel" of the paper (R&W Eq. 4.9): sd^2 exp(-r^2 / 2 l^2).
struct SquaredExponential {
  static constexpr std::size_t kSize = 2;
  double sd = 1.0;
  double length_scale_m = 1.0;

  double operator()(const Lag& lag) const { return sd * sd * std::exp(-0.5 * squared(lag)); }
  CovarianceValue<2> with_gradient(const Lag& lag) const {
    const double k = (*this)(lag);
    return {k, {2 * k, k * squared(lag)}};
  }
  std::array<CovarianceParameter, 2> parameters() const {
    return {{{"signal_sd", "uT", sd}, {"length_scale", "m", length_scale_m}}};
  }
  static SquaredExponential from_logs(const std::array<double, 2>& logs) {
    return {std::exp(logs[0]), std::exp(logs[1])};
  }

 private:
  double squared(const Lag& lag) const {
    return lag.difference_m.squaredNorm() / (length_scale_m * length_scale_m);
  }
};

/// The same with a length scale for each axis (R&W Eq. 5.1): separable, so its factors can be worked on one
/// by one.
struct SquaredExponentialXY {
  static constexpr std::size_t kSize = 3;
  double sd = 1.0;
  double length_scale_x_m = 1.0;
  double length_scale_y_m = 1.0;

  double operator()(const Lag& lag) const { return sd * sd * std::exp(-0.5 * squared(lag).sum()); }
  CovarianceValue<3> with_gradient(const Lag& lag) const {
    const double k = (*this)(lag);
    const Eigen::Array2d u = squared(lag);
    return {k, {2 * k, k * u.x(), k * u.y()}};
  }
  std::array<CovarianceParameter, 3> parameters() const {
    return {{{"signal_sd", "uT", sd},
             {"length_scale_x", "m", length_scale_x_m},
             {"length_scale_y", "m", length_scale_y_m}}};
  }
  static SquaredExponentialXY from_logs(const std::array<double, 3>& logs) {
    return {std::exp(logs[0]), std::exp(logs[1]), std::exp(logs[2])};
  }

 private:
  Eigen::Array2d squared(const Lag& lag) const {
    return (lag.difference_m.array() / Eigen::Array2d(length_scale_x_m, length_scale_y_m)).square();
  }
};

/// Matern with nu = 3/2 (R&W Eq. 4.17): once differentiable fields.
struct Matern32 {
  static constexpr std::size_t kSize = 2;
  double sd = 1.0;
  double length_scale_m = 1.0;

  double operator()(const Lag& lag) const { return with_gradient(lag).value; }
  CovarianceValue<2> with_gradient(const Lag& lag) const {
    const double s = std::sqrt(3.0) * lag.difference_m.norm() / length_scale_m;
    const double e = sd * sd * std::exp(-s);
    return {(1 + s) * e, {2 * (1 + s) * e, s * s * e}};
  }
  std::array<CovarianceParameter, 2> parameters() const {
    return {{{"signal_sd", "uT", sd}, {"length_scale", "m", length_scale_m}}};
  }
  static Matern32 from_logs(const std::array<double, 2>& logs) {
    return {std::exp(logs[0]), std::exp(logs[1])};
  }
};

/// Matern with nu = 5/2 (R&W Eq. 4.17): twice differentiable fields.
struct Matern52 {
  static constexpr std::size_t kSize = 2;
  double sd = 1.0;
  double length_scale_m = 1.0;

  double operator()(const Lag& lag) const { return with_gradient(lag).value; }
  CovarianceValue<2> with_gradient(const Lag& lag) const {
    const double s = std::sqrt(5.0) * lag.difference_m.norm() / length_scale_m;
    const double e = sd * sd * std::exp(-s);
    const double k = (1 + s + s * s / 3) * e;
    return {k, {2 * k, s * s * (1 + s) / 3 * e}};
  }
  std::array<CovarianceParameter, 2> parameters() const {
    return {{{"signal_sd", "uT", sd}, {"length_scale", "m", length_scale_m}}};
  }
  static Matern52 from_logs(const std::array<double, 2>& logs) {
    return {std::exp(logs[0]), std::exp(logs[1])};
  }
};

/// Two covariance functions side by side; what Sum and Product share.
template <CovarianceFunction A, CovarianceFunction B>
struct Pair {
  static constexpr std::size_t kSize = A::kSize + B::kSize;
  A a;
  B b;

 protected:
  template <typename T>
  static std::array<T, kSize> joined(const std::array<T, A::kSize>& first,
                                     const std::array<T, B::kSize>& second) {
    std::array<T, kSize> all;
    for (std::size_t i = 0; i < kSize; ++i) all[i] = i < A::kSize ? first[i] : second[i - A::kSize];
    return all;
  }
  static std::pair<A, B> split(const std::array<double, kSize>& logs) {
    std::array<double, A::kSize> first;
    std::array<double, B::kSize> second;
    for (std::size_t i = 0; i < kSize; ++i) (i < A::kSize ? first[i] : second[i - A::kSize]) = logs[i];
    return {A::from_logs(first), B::from_logs(second)};
  }
};

template <CovarianceFunction A, CovarianceFunction B>
struct Sum : Pair<A, B> {
  static constexpr std::size_t kSize = Pair<A, B>::kSize;

  double operator()(const Lag& lag) const { return this->a(lag) + this->b(lag); }
  CovarianceValue<kSize> with_gradient(const Lag& lag) const {
    const auto ka = this->a.with_gradient(lag);
    const auto kb = this->b.with_gradient(lag);
    return {ka.value + kb.value, this->joined(ka.by_log_parameter, kb.by_log_parameter)};
  }
  std::array<CovarianceParameter, kSize> parameters() const {
    return this->joined(this->a.parameters(), this->b.parameters());
  }
  static Sum from_logs(const std::array<double, kSize>& logs) {
    const auto [a, b] = Sum::split(logs);
    return {{a, b}};
  }
};

template <CovarianceFunction A, CovarianceFunction B>
struct Product : Pair<A, B> {
  static constexpr std::size_t kSize = Pair<A, B>::kSize;

  double operator()(const Lag& lag) const { return this->a(lag) * this->b(lag); }
  CovarianceValue<kSize> with_gradient(const Lag& lag) const {
    auto ka = this->a.with_gradient(lag);
    auto kb = this->b.with_gradient(lag);
    for (double& d : ka.by_log_parameter) d *= kb.value;
    for (double& d : kb.by_log_parameter) d *= ka.value;
    return {ka.value * kb.value, this->joined(ka.by_log_parameter, kb.by_log_parameter)};
  }
  std::array<CovarianceParameter, kSize> parameters() const {
    return this->joined(this->a.parameters(), this->b.parameters());
  }
  static Product from_logs(const std::array<double, kSize>& logs) {
    const auto [a, b] = Product::split(logs);
    return {{a, b}};
  }
};

template <CovarianceFunction A, CovarianceFunction B>
Sum<A, B> operator+(const A& a, const B& b) {
  return {{a, b}};
}

template <CovarianceFunction A, CovarianceFunction B>
Product<A, B> operator*(const A& a, const B& b) {
  return {{a, b}};
}

}  // namespace mstsl
