#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mstsl/core/angles.hpp"

/// The field of a building: the Earth's, bent by magnetised steel. Every piece of steel is a rod with one magnetic
/// charge at each end. Shares nothing with the estimators' field models.
namespace mstsl::sim {

/// The undisturbed field. Default: mid-latitude Europe (IGRF-13, about 50 deg north), magnetic north along map y.
struct EarthField {
  double strength_uT = 48.0;
  double inclination_rad = radians(65.0);  ///< downwards from the horizontal; negative in the southern hemisphere
  double north_rad = radians(90.0);        ///< yaw of magnetic north in the map frame (declination included)

  Eigen::Vector3d in_map_uT() const;
};

/// A straight piece of steel: what is needed to magnetise it.
struct Rod {
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
  double cross_section_m2 = 0.0;     ///< of the steel itself
  double remanence_A_per_m = 0.0;    ///< permanent magnetisation along from -> to; either sign
};

/// Two magnetic charges +q at `positive_m` and -q at `negative_m`; the field of each is q r / |r|^3.
struct PolePair {
  Eigen::Vector3d positive_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d negative_m = Eigen::Vector3d::Zero();
  double strength_uTm2 = 0.0;
};

/// The rod's charges: remanent magnetisation plus what the Earth's field along the rod induces, weakened by the rod's
/// own demagnetising field (prolate ellipsoid of the same slenderness, Osborn 1945).
PolePair magnetised(const Rod& rod, const EarthField& earth);

/// Field of one pair at a point, uT. Within 5 cm of a charge it is that of a charged ball, so it never diverges.
Eigen::Vector3d field_uT(const PolePair& pair, const Eigen::Vector3d& position_m);

/// Earth plus many pole pairs, summed fast: near buckets pair by pair, far ones as one dipole each. A test bounds the
/// error against the plain sum.
class SteelField {
 public:
  SteelField() = default;
  SteelField(const EarthField& earth, std::vector<PolePair> pairs);

  const EarthField& earth() const { return earth_; }
  const std::vector<PolePair>& pairs() const { return pairs_; }

  /// The flux density at a point of the building, map frame, uT.
  Eigen::Vector3d field_uT(const Eigen::Vector3d& position_m) const;

 private:
  struct Bucket {
    Eigen::Vector3d middle_m;        ///< centre of its charges, weighted by strength
    Eigen::Vector3d moment_uTm3;     ///< sum of q * (positive - negative)
    double near_m2;                  ///< squared distance within which its pairs are summed one by one
    std::uint32_t first, last;       ///< its range in pairs_
  };

  EarthField earth_;
  Eigen::Vector3d background_uT_ = EarthField{}.in_map_uT();
  std::vector<PolePair> pairs_;      ///< bucket by bucket
  std::vector<Bucket> buckets_;
};

}  // namespace mstsl::sim
