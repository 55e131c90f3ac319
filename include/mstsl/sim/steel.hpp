#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/angles.hpp"

/// The field of a building: the Earth's, bent by magnetised steel. Every piece of steel is a rod with one
/// magnetic charge at each end. Shares nothing with the estimators' field models.
namespace mstsl::sim {

/// The undisturbed field. Default: mid-latitude Europe (IGRF-13, about 50 deg north), magnetic north along
/// map y.
struct EarthField {
  double strength_uT = 48.0;
  double inclination_rad =
      radians(65.0);                 ///< downwards from the horizontal; negative in the southern hemisphere
  double north_rad = radians(90.0);  ///< yaw of magnetic north in the map frame (declination included)

  Eigen::Vector3d in_map_uT() const;
};

/// A straight piece of steel: what is needed to magnetise it.
struct Rod {
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
  double cross_section_m2 = 0.0;   ///< of the steel itself
  double remanence_A_per_m = 0.0;  ///< permanent magnetisation along from -> to; either sign
};

/// Two magnetic charges +q at `positive_m` and -q at `negative_m`; the field of each is q r / |r|^3.
struct PolePair {
  Eigen::Vector3d positive_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d negative_m = Eigen::Vector3d::Zero();
  double strength_uTm2 = 0.0;
};

/// The rod's charges: remanent magnetisation plus what the Earth's field along the rod induces, weakened by
/// the rod's own demagnetising field (prolate ellipsoid of the same slenderness, Osborn 1945).
PolePair magnetised(const Rod& rod, const EarthField& earth);

/// A charge is a ball of this radius, inside which its field falls to 0: it never diverges.
inline constexpr double kChargeRadius_m = 0.05;

/// Field of one pair at a point, uT.
Eigen::Vector3d field_uT(const PolePair& pair, const Eigen::Vector3d& position_m);

/// Earth plus many pole pairs, summed fast by a tree (Barnes & Hut 1986): near pairs one by one, far groups
/// of them as one dipole each. A test bounds the error against the plain sum.
class SteelField {
 public:
  SteelField() = default;
  SteelField(const EarthField& earth, std::vector<PolePair> pairs);

  const EarthField& earth() const { return earth_; }
  /// The pairs, in an order of the tree's own.
  const std::vector<PolePair>& pairs() const { return pairs_; }

  /// The flux density at a point of the building, map frame, uT.
  Eigen::Vector3d field_uT(const Eigen::Vector3d& position_m) const;

 private:
  struct Node {
    Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();     ///< of its pairs, weighted by their moments
    Eigen::Vector3d moment_uTm3 = Eigen::Vector3d::Zero();  ///< sum of q * (positive - negative)
    double near_m2 = 0.0;               ///< squared distance within which it must be looked at more closely
    std::uint32_t first = 0, last = 0;  ///< its range in pairs_
    std::uint32_t next = 0;             ///< the node after its last descendant; a leaf's own successor
  };

  void build(std::size_t first, std::size_t last);
  Eigen::Vector3d near_field_uT(const Node& leaf, const Eigen::Vector3d& position_m) const;

  EarthField earth_;
  Eigen::Vector3d background_uT_ = EarthField{}.in_map_uT();
  std::vector<PolePair> pairs_;
  Eigen::Array<double, Eigen::Dynamic, 4>
      charges_;              ///< x, y, z in m and strength, two rows a pair: for fast sums
  std::vector<Node> nodes_;  ///< depth first
};

}  // namespace mstsl::sim
