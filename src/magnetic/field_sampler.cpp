#include "mstsl/magnetic/field_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mstsl {

FieldSampler::FieldSampler(const FieldMap& map) : geometry_(map.geometry), frame_(map.geometry) {
  const Entry nothing{Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()),
                      Eigen::Vector3f::Zero()};
  entries_.assign(geometry_.size(), nothing);
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (map.mean_uT[i].allFinite() && map.variance_uT2[i].allFinite())
      entries_[i] = {map.mean_uT[i], map.variance_uT2[i].cwiseMax(0.0f)};
  measure_spread(map);
  measure_length(map);
  fall_back_on_spread();
}

void FieldSampler::measure_spread(const FieldMap& map) {
  Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (map.supported[i] == 0 || !entries_[i].mean_uT.allFinite()) continue;
    const Eigen::Array3d value = entries_[i].mean_uT.cast<double>().array();
    sum += value, squares += value.square(), count += 1;
  }
  if (count < 1) return;
  mean_uT_ = (sum / count).matrix();
  spread_uT_ = (squares / count - mean_uT_.array().square()).max(0.0).sqrt().matrix();
}

void FieldSampler::measure_length(const FieldMap& map) {
  constexpr double kLag_m = 0.5;
  const int lag = std::max(1, static_cast<int>(std::lround(kLag_m / geometry_.resolution_m)));
  const auto usable = [&](std::size_t i) { return map.supported[i] != 0 && entries_[i].mean_uT.allFinite(); };
  double squares = 0, pairs = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!usable(i)) continue;
    const Cell cell = geometry_.cell(i);
    for (const Cell next : {Cell{cell.column + lag, cell.row}, Cell{cell.column, cell.row + lag}}) {
      if (!geometry_.contains(next) || !usable(geometry_.index(next))) continue;
      squares += (entries_[geometry_.index(next)].mean_uT - entries_[i].mean_uT).cast<double>().squaredNorm();
      pairs += 1;
    }
  }
  const double variance = spread_uT_.squaredNorm();
  if (pairs < 1 || !(variance > 0)) return;
  const double correlation = 1.0 - 0.5 * squares / pairs / variance;
  // (1 + a) exp(-a) falls from 1 to 0: halve the interval of lengths that holds the answer.
  double low = 0.3, high = 3.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high), a = std::sqrt(3.0) * lag * geometry_.resolution_m / middle;
    ((1 + a) * std::exp(-a) < correlation ? low : high) = middle;
  }
  length_m_ = 0.5 * (low + high);
}

void FieldSampler::fall_back_on_spread() {
  const Eigen::Array3f mean = mean_uT_.cast<float>().array(),
                       most = spread_uT_.cast<float>().array().square();
  for (Entry& entry : entries_) {
    const Eigen::Array3f claimed = entry.variance_uT2.array();
    // How much of what is known here is known without a map.
    const Eigen::Array3f share = (claimed > most && most > 0.0F).select(1.0F - most / claimed, 0.0F);
    entry.mean_uT = (entry.mean_uT.array() + share * (mean - entry.mean_uT.array())).matrix();
    entry.variance_uT2 = (most > 0.0F).select(claimed.min(most), claimed).matrix();
  }
}

FieldSampler::Sample FieldSampler::unknown() const {
  return {mean_uT_, spread_uT_.cwiseAbs2(), Eigen::Matrix<double, 3, 2>::Zero(), false};
}

FieldSampler::Sample FieldSampler::sample(const Eigen::Vector2d& map_point_m) const {
  const Eigen::Vector2d from_center = frame_.to_grid(map_point_m).array() - 0.5;
  const Cell low = GridFrame::cell_of(from_center);
  if (low.column < 0 || low.row < 0 || low.column + 1 >= geometry_.columns || low.row + 1 >= geometry_.rows)
    return unknown();
  const std::size_t i = geometry_.index(low), up = i + static_cast<std::size_t>(geometry_.columns);
  const Entry &e00 = entries_[i], &e10 = entries_[i + 1], &e01 = entries_[up], &e11 = entries_[up + 1];
  const auto u = static_cast<float>(from_center.x() - low.column);
  const auto v = static_cast<float>(from_center.y() - low.row);
  const Eigen::Vector3f bottom = e00.mean_uT + u * (e10.mean_uT - e00.mean_uT);
  const Eigen::Vector3f top = e01.mean_uT + u * (e11.mean_uT - e01.mean_uT);
  const Eigen::Vector3f mean = bottom + v * (top - bottom);
  if (!mean.allFinite()) return unknown();
  const Eigen::Vector3f var_bottom = e00.variance_uT2 + u * (e10.variance_uT2 - e00.variance_uT2);
  const Eigen::Vector3f var_top = e01.variance_uT2 + u * (e11.variance_uT2 - e01.variance_uT2);
  const Eigen::Vector3f along_x = (1 - v) * (e10.mean_uT - e00.mean_uT) + v * (e11.mean_uT - e01.mean_uT);
  Eigen::Matrix<double, 3, 2> per_cell;
  per_cell << along_x.cast<double>(), (top - bottom).cast<double>();
  Sample sample{mean.cast<double>(), (var_bottom + v * (var_top - var_bottom)).cast<double>(), per_cell,
                true};
  for (int k = 0; k < 3; ++k)
    sample.slope_uT_m.row(k) = frame_.slope_to_map(per_cell.row(k).transpose()).transpose();
  return sample;
}

}  // namespace mstsl
