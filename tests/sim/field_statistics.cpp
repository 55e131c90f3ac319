#include "field_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <map>
#include <utility>

namespace mstsl::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBin_m = 0.1;
constexpr std::size_t kBins = 60;

/// Mean squared differences of the field by separation, each axis as it is: a variogram.
class Variogram {
 public:
  void add(double separation_m, const Vector3d& difference_uT) {
    const auto bin = static_cast<std::size_t>(separation_m / kBin_m);
    if (bin >= kBins) return;
    sum_[bin] += difference_uT.squaredNorm();
    count_[bin] += 1.0;
  }
  /// The separation at which half the squared difference reaches half of the variance: correlation 0.5.
  double half_m(double variance) const {
    double last_at = 0.0, last = 0.0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      if (count_[bin] < 30) continue;
      const double at = (static_cast<double>(bin) + 0.5) * kBin_m,
                   share = 0.5 * sum_[bin] / count_[bin] / variance;
      if (share >= 0.5) return last_at + (at - last_at) * (0.5 - last) / (share - last);
      last_at = at;
      last = share;
    }
    return 0.0;
  }
  double correlation_at(double separation_m, double variance) const {
    const auto bin = static_cast<std::size_t>(separation_m / kBin_m);
    return 1.0 - 0.5 * sum_[bin] / count_[bin] / variance;
  }

 private:
  std::array<double, kBins> sum_{}, count_{};
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The way the path runs at a sample, over about half a metre.
Vector2d direction(const FieldPath& path, std::size_t i) {
  const std::size_t before = i >= 5 ? i - 5 : 0, after = std::min(i + 5, path.size() - 1);
  return (path[after].position_m - path[before].position_m).normalized();
}

Variogram along_variogram(const std::vector<FieldPath>& paths) {
  Variogram variogram;
  for (const FieldPath& path : paths)
    for (std::size_t i = 0; i < path.size(); ++i) {
      double walked_m = 0.0;
      for (std::size_t j = i + 1; j < path.size() && walked_m < kBin_m * kBins; ++j) {
        walked_m += (path[j].position_m - path[j - 1].position_m).norm();
        variogram.add(walked_m, path[j].field_uT - path[i].field_uT);
      }
    }
  return variogram;
}

/// Pairs of samples beside one another on parallel stretches.
Variogram across_variogram(const std::vector<FieldPath>& paths) {
  using Key = std::pair<int, int>;
  constexpr double kReach_m = 3.0, kAbreast_m = 0.1, kParallel = 0.95;
  struct Entry {
    FieldSample sample;
    Vector2d along;
  };
  std::map<Key, std::vector<Entry>> cells;
  const auto key = [](const Vector2d& p) {
    return Key{static_cast<int>(std::floor(p.x() / kReach_m)),
               static_cast<int>(std::floor(p.y() / kReach_m))};
  };
  for (const FieldPath& path : paths)
    for (std::size_t i = 0; i < path.size(); i += 2)
      cells[key(path[i].position_m)].push_back({path[i], direction(path, i)});
  Variogram variogram;
  for (const auto& [at, entries] : cells)
    for (const Entry& a : entries)
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy) {
          const auto found = cells.find({at.first + dx, at.second + dy});
          if (found == cells.end()) continue;
          for (const Entry& b : found->second) {
            const Vector2d apart = b.sample.position_m - a.sample.position_m;
            const double along = apart.dot(a.along),
                         across = std::abs(a.along.x() * apart.y() - a.along.y() * apart.x());
            if (std::abs(along) < kAbreast_m && across > 0.05 && std::abs(a.along.dot(b.along)) > kParallel)
              variogram.add(across, b.sample.field_uT - a.sample.field_uT);
          }
        }
  return variogram;
}

}  // namespace

FieldStatistics statistics(const std::vector<FieldPath>& paths) {
  Vector3d sum = Vector3d::Zero(), square = Vector3d::Zero(), fourth = Vector3d::Zero();
  double count = 0.0;
  for (const FieldPath& path : paths)
    for (const FieldSample& sample : path) sum += sample.field_uT, count += 1.0;
  const Vector3d mean = sum / count;
  for (const FieldPath& path : paths)
    for (const FieldSample& sample : path) {
      const Eigen::Array3d d = sample.field_uT - mean;
      square += d.square().matrix();
      fourth += d.square().square().matrix();
    }
  FieldStatistics result;
  result.sd_uT = (square / count).cwiseSqrt();
  result.kurtosis = (fourth.array() / count / (square.array() / count).square()).mean();
  const double variance = result.sd_uT.squaredNorm();
  const Variogram along = along_variogram(paths), across = across_variogram(paths);
  result.along_m = along.half_m(variance);
  result.across_m = across.half_m(variance);
  result.along_at_half_m = along.correlation_at(0.5, variance);
  result.across_at_half_m = across.correlation_at(0.5, variance);

  std::vector<double> gradients, local;
  for (const FieldPath& path : paths) {
    for (std::size_t i = 0; i < path.size(); ++i)
      for (std::size_t j = i + 1; j < path.size(); ++j) {
        const double apart = (path[j].position_m - path[i].position_m).norm();
        if (apart < 0.2) continue;
        gradients.push_back((path[j].field_uT - path[i].field_uT).norm() / apart);
        break;
      }
    constexpr std::size_t kStretch = 100;  // 5 m of samples
    for (std::size_t first = 0; first + kStretch <= path.size(); first += kStretch) {
      Vector3d part = Vector3d::Zero();
      for (std::size_t i = first; i < first + kStretch; ++i) part += path[i].field_uT / kStretch;
      double spread = 0.0;
      for (std::size_t i = first; i < first + kStretch; ++i)
        spread += (path[i].field_uT - part).squaredNorm() / kStretch;
      local.push_back(std::sqrt(spread));
    }
  }
  result.gradient_uT_m = {quantile(gradients, 0.05), quantile(gradients, 0.5), quantile(gradients, 0.95)};
  result.local_sd_low_uT = quantile(local, 0.1);
  result.local_sd_high_uT = quantile(local, 0.9);
  return result;
}

std::vector<FieldPath> lane_paths(const sim::World& world, double shift_m, double height_m) {
  std::vector<FieldPath> paths;
  for (const sim::Lane& lane : world.lanes()) {
    const double whole = length(lane.center);
    const Vector2d ahead = (lane.center.b - lane.center.a) / whole, aside(-ahead.y(), ahead.x());
    FieldPath path;
    for (double s = 0.0; s <= whole; s += 0.05) {
      const Vector2d at = lane.center.a + s * ahead + shift_m * aside;
      path.push_back({at, world.field_uT({at.x(), at.y(), height_m})});
    }
    paths.push_back(path);
  }
  return paths;
}

std::vector<FieldPath> survey_paths(const sim::World& world, double height_m) {
  std::vector<FieldPath> paths;
  for (const double shift : {0.0, -0.5, 0.5, 0.7})
    for (FieldPath& path : lane_paths(world, shift, height_m)) paths.push_back(std::move(path));
  return paths;
}

FieldPath read_cea(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  FieldPath path;
  while (std::getline(in, line)) {
    double x, y, z, bx, by, bz;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &bx, &by, &bz) == 6)
      path.push_back({{x, y}, {bx, by, bz}});
  }
  return path;
}

}  // namespace mstsl::test
