#include "mstsl/magnetic/predictors.hpp"

#include <memory>

#include "mstsl/magnetic/gaussian_process.hpp"

#include "bilinear_lattice.hpp"

namespace mstsl {
namespace {

using Predictions = std::vector<std::optional<FieldPrediction>>;

std::vector<Eigen::Vector2d> positions_of(std::span<const Fingerprint> fingerprints) {
  std::vector<Eigen::Vector2d> positions;
  for (const Fingerprint& f : fingerprints) positions.push_back(f.position_m);
  return positions;
}

/// Some components, sharing one covariance, by exact regression; false where the matrix cannot be solved.
bool regress(const FieldHyperparameters& h, const std::vector<int>& components,
             std::span<const Fingerprint> training, std::span<const Eigen::Vector2d> points_m,
             std::vector<FieldPrediction>& predictions) {
  const int first = components.front();
  const auto kernel = SquaredExponential{1.0, h.length_scale_m(first)} +
                      WhiteNoise{h.noise_sd_uT(first) / h.signal_sd_uT(first)};
  Eigen::MatrixXd values(static_cast<Eigen::Index>(training.size()),
                         static_cast<Eigen::Index>(components.size()));
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      const int c = components[k];
      values(i, k) = (training[i].field_uT(c) - h.mean_uT(c)) / h.signal_sd_uT(c);
    }
  const auto regression = fit_exactly(kernel, positions_of(training), values, false);
  if (!regression) return false;
  const auto result = regression->predict(points_m);
  for (Eigen::Index i = 0; i < result.mean.rows(); ++i)
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      const int c = components[k];
      predictions[i].mean_uT(c) = h.mean_uT(c) + h.signal_sd_uT(c) * result.mean(i, k);
      predictions[i].variance_uT2(c) = h.signal_sd_uT(c) * h.signal_sd_uT(c) * result.variance(i);
    }
  return true;
}

}  // namespace

Predictor gpr_predictor(const FieldHyperparameters& h) {
  return
      [h](std::span<const Fingerprint> training, std::span<const Eigen::Vector2d> points_m) -> Predictions {
        std::vector<FieldPrediction> predictions(points_m.size());
        for (const std::vector<int>& components : components_by_covariance(h))
          if (!regress(h, components, training, points_m, predictions)) return Predictions(points_m.size());
        return {predictions.begin(), predictions.end()};
      };
}

Predictor bilinear_predictor(double spacing_m) {
  return [spacing_m](std::span<const Fingerprint> training, std::span<const Eigen::Vector2d> points_m) {
    const BilinearLattice lattice(positions_of(training), training, spacing_m);
    Predictions predictions;
    for (const Eigen::Vector2d& point : points_m) {
      const auto mean = lattice.at(point);
      predictions.push_back(mean ? std::optional(FieldPrediction{*mean, Eigen::Vector3d::Zero()})
                                 : std::nullopt);
    }
    return predictions;
  };
}

Predictor nearest_predictor(double reach_m) {
  return [reach_m](std::span<const Fingerprint> training, std::span<const Eigen::Vector2d> points_m) {
    Predictions predictions;
    for (const Eigen::Vector2d& point : points_m) {
      double nearest_m = reach_m;
      std::optional<FieldPrediction> prediction;
      for (const Fingerprint& f : training) {
        const double distance_m = (f.position_m - point).norm();
        if (distance_m > nearest_m) continue;
        nearest_m = distance_m;
        prediction = FieldPrediction{f.field_uT, Eigen::Vector3d::Zero()};
      }
      predictions.push_back(prediction);
    }
    return predictions;
  };
}

}  // namespace mstsl
