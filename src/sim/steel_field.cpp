#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "mstsl/sim/steel.hpp"

namespace mstsl::sim {
namespace {

/// Side of the cubes that pairs are gathered in, by their middles.
constexpr double kBucket_m = 2.0;
/// A bucket is taken as one dipole from this many times its radius on; the first neglected term falls with the cube.
constexpr double kOpening = 4.0;

std::array<int, 3> bucket_of(const PolePair& pair) {
  const Eigen::Vector3d middle = 0.5 * (pair.positive_m + pair.negative_m) / kBucket_m;
  return {static_cast<int>(std::floor(middle.x())), static_cast<int>(std::floor(middle.y())),
          static_cast<int>(std::floor(middle.z()))};
}

Eigen::Vector3d moment_uTm3(const PolePair& pair) {
  return pair.strength_uTm2 * (pair.positive_m - pair.negative_m);
}

/// Field of a point dipole at the offset r from it, in uT for a moment in uT m^3.
Eigen::Vector3d dipole_field(const Eigen::Vector3d& moment, const Eigen::Vector3d& r, double squared) {
  const double inverse_cube = 1.0 / (squared * std::sqrt(squared));
  return inverse_cube * (3.0 * moment.dot(r) / squared * r - moment);
}

}  // namespace

SteelField::SteelField(const EarthField& earth, std::vector<PolePair> pairs)
    : earth_(earth), background_uT_(earth.in_map_uT()) {
  std::map<std::array<int, 3>, std::vector<PolePair>> sorted;
  for (const PolePair& pair : pairs) sorted[bucket_of(pair)].push_back(pair);
  pairs_.reserve(pairs.size());
  for (const auto& [key, members] : sorted) {
    Bucket bucket{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0, static_cast<std::uint32_t>(pairs_.size()), 0};
    double weight = 0.0;
    for (const PolePair& pair : members) {
      const double w = moment_uTm3(pair).norm() + 1e-12;
      bucket.middle_m += 0.5 * w * (pair.positive_m + pair.negative_m);
      bucket.moment_uTm3 += moment_uTm3(pair);
      weight += w;
    }
    bucket.middle_m /= weight;
    double radius_m = 0.0;
    for (const PolePair& pair : members)
      radius_m = std::max({radius_m, (pair.positive_m - bucket.middle_m).norm(), (pair.negative_m - bucket.middle_m).norm()});
    bucket.near_m2 = std::pow(kOpening * radius_m, 2);
    pairs_.insert(pairs_.end(), members.begin(), members.end());
    bucket.last = static_cast<std::uint32_t>(pairs_.size());
    buckets_.push_back(bucket);
  }
}

Eigen::Vector3d SteelField::field_uT(const Eigen::Vector3d& position_m) const {
  Eigen::Vector3d sum = background_uT_;
  for (const Bucket& bucket : buckets_) {
    const Eigen::Vector3d r = position_m - bucket.middle_m;
    const double squared = r.squaredNorm();
    if (squared >= bucket.near_m2) {
      sum += dipole_field(bucket.moment_uTm3, r, squared);
    } else {
      for (std::uint32_t i = bucket.first; i < bucket.last; ++i) sum += sim::field_uT(pairs_[i], position_m);
    }
  }
  return sum;
}

}  // namespace mstsl::sim
