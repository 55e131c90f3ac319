#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace mstsl {

/// Seeded random numbers, always passed in. The same seed gives the same numbers with every standard library,
/// because only the engine (fixed by the C++ standard) is taken from it and the distributions are our own.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  /// An independent generator for one part of the work (a run, a sensor, a tile). It depends on this one's
  /// seed and `stream` only, not on how many numbers were drawn, so that parts can be made in any order, on
  /// any thread.
  [[nodiscard]] Random fork(std::uint64_t stream) const;

  /// In [0, 1).
  double uniform();
  /// In [low, high).
  double uniform(double low, double high);
  /// In 0 .. count-1; expects count > 0.
  std::size_t index(std::size_t count);
  /// Mean 0, standard deviation 1.
  double normal();
  double normal(double mean, double standard_deviation);
  bool chance(double probability);

 private:
  std::uint64_t seed_;
  std::mt19937_64 engine_;
};

}  // namespace mstsl
