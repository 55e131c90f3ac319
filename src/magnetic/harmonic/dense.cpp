#include "dense.hpp"

#include <optional>
#include <vector>

#include "mstsl/magnetic/gaussian_process.hpp"

namespace mstsl {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using Predictions = std::vector<std::optional<FieldPrediction>>;

Predictions predict(const HarmonicHyperparameters& h, std::span<const Fingerprint> training,
                    std::span<const Eigen::Vector2d> points_m) {
  std::vector<Eigen::Vector2d> positions_m;
  for (const Fingerprint& f : training) positions_m.push_back(f.position_m);
  const auto n = static_cast<Index>(training.size());
  MatrixXd covariance = harmonic_covariance(h, positions_m, positions_m);
  for (int c = 0; c < 3; ++c)
    covariance.diagonal().segment(c * n, n).array() += h.noise_sd_uT(c) * h.noise_sd_uT(c);
  const auto system = GaussianSystem::make(std::move(covariance), stacked(h, training), false);
  if (!system) return Predictions(points_m.size());
  const MatrixXd cross = harmonic_covariance(h, points_m, positions_m);
  const auto m = static_cast<Index>(points_m.size());
  VectorXd prior(3 * m);
  for (int c = 0; c < 3; ++c) prior.segment(c * m, m).setConstant(h.component_sd_uT().square()(c));
  const VectorXd mean = system->predict_mean(cross), variance = system->predict_variance(cross, prior);
  Predictions predictions;
  for (Index i = 0; i < m; ++i) {
    FieldPrediction at;
    for (int c = 0; c < 3; ++c) {
      at.mean_uT(c) = h.mean_uT(c) + mean(c * m + i);
      at.variance_uT2(c) = variance(c * m + i);
    }
    predictions.emplace_back(at);
  }
  return predictions;
}

}  // namespace

MatrixXd harmonic_covariance(const HarmonicHyperparameters& h, std::span<const Eigen::Vector2d> rows_m,
                             std::span<const Eigen::Vector2d> columns_m) {
  const auto rows = static_cast<Index>(rows_m.size()), columns = static_cast<Index>(columns_m.size());
  const double variance = h.signal_sd_uT * h.signal_sd_uT;
  MatrixXd covariance(3 * rows, 3 * columns);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) {
      const Eigen::Matrix3d block =
          variance * harmonic_covariance(h.side, h.depth_m, rows_m[i] - columns_m[j]);
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) covariance(a * rows + i, b * columns + j) = block(a, b);
    }
  return covariance;
}

VectorXd stacked(const HarmonicHyperparameters& h, std::span<const Fingerprint> fingerprints) {
  const auto n = static_cast<Index>(fingerprints.size());
  VectorXd values(3 * n);
  for (Index i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) values(c * n + i) = fingerprints[i].field_uT(c) - h.mean_uT(c);
  return values;
}

Predictor harmonic_predictor(const HarmonicHyperparameters& h) {
  return [h](std::span<const Fingerprint> training, std::span<const Eigen::Vector2d> points_m) {
    return predict(h, training, points_m);
  };
}

}  // namespace mstsl
