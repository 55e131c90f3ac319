#include "mstsl/magnetic/unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace mstsl {
namespace {

/// A unit, and the norms [low, high) that speak for it.
struct Candidate {
  FieldUnit unit;
  std::string_view name;
  double microtesla;
  double low, high;
};

/// 10 to 150 uT in each unit. Where two units overlap they are cut so that the less extreme field is
/// believed: 0.8 may be 80 uT in gauss (above all the Earth has) or 40 uT normalised; 150 may be 150 uT or,
/// in milligauss, 15 uT. Tesla, what the interface promises, has no neighbour: there the field may be as weak
/// as where steel undoes the Earth's, and as strong as beside a magnet.
constexpr std::array<Candidate, 6> kCandidates{{
    {FieldUnit::kTesla, "tesla", 1e6, 2e-6, 1000e-6},
    {FieldUnit::kMicrotesla, "microtesla", 1.0, 10.0, 150.0},
    {FieldUnit::kNanotesla, "nanotesla", 1e-3, 10e3, 150e3},
    {FieldUnit::kGauss, "gauss", 100.0, 0.1, 0.8},
    {FieldUnit::kMilligauss, "milligauss", 0.1, 150.0, 1500.0},
    {FieldUnit::kNormalised, "normalised", 50.0, 0.8, 3.0},
}};

const Candidate& candidate(FieldUnit unit) { return *std::ranges::find(kCandidates, unit, &Candidate::unit); }

}  // namespace

std::string_view to_string(FieldUnit unit) { return candidate(unit).name; }

double microtesla_per(FieldUnit unit) { return candidate(unit).microtesla; }

Result<FieldUnit> detect_unit(std::span<const double> norms) {
  std::vector<double> finite;
  std::ranges::copy_if(norms, std::back_inserter(finite), [](double norm) { return std::isfinite(norm); });
  if (finite.empty()) return Error("none of the first magnetic readings is a finite number");
  const auto middle = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / 2);
  std::ranges::nth_element(finite, middle);
  const double median = *middle;
  for (const Candidate& candidate : kCandidates)
    if (median >= candidate.low && median < candidate.high) return candidate.unit;
  return Error(
      fmt::format("the magnetic readings have a median strength of {:.4g}, which is no field found in a "
                  "building (10 to 150 uT) in "
                  "tesla, microtesla, nanotesla, gauss, milligauss or normalised units; check the driver's "
                  "scale and the topic",
                  median));
}

}  // namespace mstsl
