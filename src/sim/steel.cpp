#include "mstsl/sim/steel.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mstsl::sim {
namespace {

/// Susceptibility of structural steel in weak fields (initial relative permeability 100-300; Bozorth 1951).
constexpr double kSusceptibility = 200.0;
/// B in uT to H in A/m: 1e-6 / (4 pi 1e-7).
constexpr double kAmperePerMetrePerMicrotesla = 1.0 / (0.4 * kPi);
/// Charge in A m to uT m^2: mu0 / (4 pi) = 1e-7 T m / A.
constexpr double kMicroteslaSquareMetrePerAmpereMetre = 0.1;

/// Demagnetising factor along the long axis of a prolate ellipsoid (Osborn 1945, Eq. 2.17); `slenderness`
/// > 1.
double demagnetising_factor(double slenderness) {
  const double m2 = slenderness * slenderness - 1.0;
  const double root = std::sqrt(m2);
  return (slenderness / root * std::log(slenderness + root) - 1.0) / m2;
}

/// r / |r|^3 outside the charge's ball, r / radius^3 inside it.
Eigen::Vector3d unit_charge_field(const Eigen::Vector3d& r) {
  const double squared = std::max(r.squaredNorm(), kChargeRadius_m * kChargeRadius_m);
  return r / (squared * std::sqrt(squared));
}

}  // namespace

Eigen::Vector3d EarthField::in_map_uT() const {
  const double horizontal = std::cos(inclination_rad);
  return strength_uT * Eigen::Vector3d(horizontal * std::cos(north_rad), horizontal * std::sin(north_rad),
                                       -std::sin(inclination_rad));
}

PolePair magnetised(const Rod& rod, const EarthField& earth) {
  const Eigen::Vector3d along = rod.to_m - rod.from_m;
  const double length_m = along.norm();
  assert(length_m > 0 && rod.cross_section_m2 > 0);
  const double diameter_m = 2.0 * std::sqrt(rod.cross_section_m2 / kPi);
  // A piece shorter than it is thick is taken as a little longer than a ball, where the formula ends.
  const double n = demagnetising_factor(std::max(1.01, length_m / diameter_m));
  const double h_along_A_per_m = earth.in_map_uT().dot(along) / length_m * kAmperePerMetrePerMicrotesla;
  const double induced_A_per_m = kSusceptibility / (1.0 + n * kSusceptibility) * h_along_A_per_m;
  const double charge_Am = (induced_A_per_m + rod.remanence_A_per_m) * rod.cross_section_m2;
  return {rod.to_m, rod.from_m, kMicroteslaSquareMetrePerAmpereMetre * charge_Am};
}

Eigen::Vector3d field_uT(const PolePair& pair, const Eigen::Vector3d& position_m) {
  return pair.strength_uTm2 *
         (unit_charge_field(position_m - pair.positive_m) - unit_charge_field(position_m - pair.negative_m));
}

}  // namespace mstsl::sim
