#include "mstsl/core/random.hpp"

#include <cassert>
#include <cmath>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014): spreads near seeds far apart.
std::uint64_t mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed) : seed_(seed), engine_(mix(seed)) {}

Random Random::fork(std::uint64_t stream) const { return Random(mix(seed_) ^ mix(~stream)); }

double Random::uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::size_t Random::index(std::size_t count) {
  assert(count > 0);
  return static_cast<std::size_t>(uniform() * static_cast<double>(count));
}

double Random::normal() {
  const double radius = std::sqrt(-2.0 * std::log1p(-uniform()));  // Box & Muller 1958
  return radius * std::cos(2.0 * kPi * uniform());
}

double Random::normal(double mean, double standard_deviation) { return mean + standard_deviation * normal(); }

bool Random::chance(double probability) { return uniform() < probability; }

}  // namespace mstsl
