#include "mstsl/magnetic/outliers.hpp"

#include <algorithm>
#include <cmath>

#include "point_bins.hpp"

namespace mstsl {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Distance of `value` from the median of the others, in uT beyond what is allowed; positive for an outlier.
double excess(double value, std::vector<double>& others, const OutlierOptions& options) {
  const double center = median(others);
  for (double& other : others) other = std::abs(other - center);
  constexpr double kToStandardDeviation = 1.4826;  // of a Gaussian's median absolute deviation
  return std::abs(value - center) -
         std::max(options.least_uT, options.deviations * kToStandardDeviation * median(others));
}

}  // namespace

std::vector<std::size_t> find_outliers(std::span<const Fingerprint> fingerprints,
                                       const OutlierOptions& options) {
  constexpr std::size_t kFewest = 3, kMost = 40;
  std::vector<Eigen::Vector2d> points;
  for (const Fingerprint& f : fingerprints) points.push_back(f.position_m);
  const PointBins bins(points, options.neighbourhood_m);
  std::vector<std::size_t> outliers;
  std::vector<std::size_t> near;
  std::vector<double> values;
  for (std::size_t i = 0; i < fingerprints.size(); ++i) {
    near.clear();
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(options.neighbourhood_m);
    bins.for_each_near(points[i] - reach, points[i] + reach, [&](std::size_t j) {
      if (j != i && (points[j] - points[i]).norm() <= options.neighbourhood_m) near.push_back(j);
    });
    if (near.size() < kFewest) continue;  // nothing to be held against
    const std::size_t stride = (near.size() + kMost - 1) / kMost;
    for (int c = 0; c < 3; ++c) {
      values.clear();
      for (std::size_t k = 0; k < near.size(); k += stride)
        values.push_back(fingerprints[near[k]].field_uT(c));
      if (excess(fingerprints[i].field_uT(c), values, options) <= 0.0) continue;
      outliers.push_back(i);
      break;
    }
  }
  return outliers;
}

}  // namespace mstsl
