#include "sample_sums.hpp"

namespace mstsl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void SampleSums::sum(const WaveBox& box, std::span<const TileSample> samples, MatrixProduct& product) {
  const double low = -box.halo_m, high = box.length_m + box.halo_m;
  near.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Array2d p = samples[i].position_m.array();
    if ((p >= low).all() && (p <= high).all()) near.push_back(static_cast<Index>(i));
  }
  const auto n = static_cast<Index>(near.size());
  Eigen::MatrixX2d points_m(n, 2);
  VectorXd w(n);
  MatrixXd readings(n, 3);
  for (Index i = 0; i < n; ++i) {
    const TileSample& sample = samples[static_cast<std::size_t>(near[static_cast<std::size_t>(i)])];
    points_m.row(i) = sample.position_m.transpose();
    w(i) = sample.weight;
    readings.row(i) = sample.value.matrix().transpose();
  }
  x.evaluate(points_m.col(0), box.period_m, 2 * box.highest);
  y.evaluate(points_m.col(1), box.period_m, 2 * box.highest);
  sum_over_samples(x, y, w, 2 * box.highest, product, weights);
  for (int c = 0; c < 3; ++c)
    sum_over_samples(x, y, w.cwiseProduct(readings.col(c)), box.highest, product,
                     values[static_cast<std::size_t>(c)]);
  long_columns = long_waves_at(box, points_m);
  sum_long_waves(box, w, readings, product);
}

void SampleSums::sum_long_waves(const WaveBox& box, const VectorXd& w, const MatrixXd& readings,
                                MatrixProduct& product) {
  const MatrixXd &columns = long_columns, weighted = w.asDiagonal() * columns;
  long_products.setZero(columns.cols(), columns.cols());
  product.add(columns.transpose(), weighted, long_products);
  long_values.setZero(columns.cols(), 3);
  product.add(weighted.transpose(), readings, long_values);
  long_sums.resize(static_cast<std::size_t>(columns.cols()));
  for (Index k = 0; k < columns.cols(); ++k)
    sum_over_samples(x, y, weighted.col(k), box.highest, product, long_sums[static_cast<std::size_t>(k)]);
}

}  // namespace mstsl
