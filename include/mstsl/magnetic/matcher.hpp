#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/field_map.hpp"

namespace mstsl {

/// A measured field, already turned into the map frame, and how far the measurement may be off: sensor noise
/// plus what is left of the bias. The map's own variance is added cell by cell.
struct FieldObservation {
  Eigen::Vector3d field_uT = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_uT2 = Eigen::Matrix3d::Identity();
};

/// One distinct place where the measured field may have been seen.
struct LocationCandidate {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  /// Of the posterior around the place: the search window of the paper's section III-B is 3 sigma of it.
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
  /// Share of the posterior that lies nearer to this candidate than `separation_m` (and to no better one).
  double probability = 0.0;
  /// Natural log of the observation density at the place; of exp(-d^2 / 2 sigma^2) for k-NN.
  double log_density = 0.0;
  /// Which of the observations (e.g. the four headings) explains the place best.
  std::size_t observation = 0;
};

/// What ranks the candidates.
enum class CandidateRank {
  kPeak,  ///< the density at the best cell: the paper's "selected according to their probabilities"
  kMass   ///< the probability within `separation_m`: the best chance that the truth is near one of the
          ///< candidates
};

struct DistinctOptions {
  std::size_t count = 5;  ///< K (paper section IV-C: 5 in the office, 8 in the car park)
  double separation_m =
      1.5;  ///< candidates are at least this far apart: about the field's correlation length
  CandidateRank rank = CandidateRank::kPeak;
};

struct MatcherOptions {
  /// Leave out cells far from any fingerprint: their field is a guess that fits everything a little.
  bool supported_only = true;
  Threads threads;
};

/// Finds where a measured field may have been taken (paper section III-A.3, stage 1): the multivariate
/// Gaussian of Eq. 2 over all cells of a GPR map, or the k nearest cells or fingerprints in field space
/// (Euclidean) for the others.
class FieldMatcher {
 public:
  /// Errors: a map without a usable cell.
  static Result<FieldMatcher> make(const FieldMap& map, const MatcherOptions& options = {});
  FieldMatcher(FieldMatcher&&) noexcept;
  FieldMatcher& operator=(FieldMatcher&&) noexcept;
  ~FieldMatcher();

  /// Number of places compared: cells, or fingerprints for the fingerprint model.
  std::size_t size() const;
  Eigen::Vector2d position_m(std::size_t place) const;

  /// Natural log of the observation density at each place (size() values): a Gaussian around the place's mean
  /// with the place's variance plus the observation's covariance.
  std::vector<float> log_densities(const FieldObservation& observation) const;

  /// The `count` places whose field is nearest to the observation, nearest first (k-NN, Euclidean distance in
  /// uT).
  struct Neighbour {
    std::size_t place = 0;
    double distance_uT = 0.0;
  };
  std::vector<Neighbour> nearest(const Eigen::Vector3d& field_uT, std::size_t count) const;

  /// The best distinct places over all given observations (each equally probable beforehand), best first, by
  /// the way that belongs to the map's model. Fewer than `count` where the map has no more distinct places.
  std::vector<LocationCandidate> locate(std::span<const FieldObservation> observations,
                                        const DistinctOptions& options = {}) const;

 private:
  struct State;
  explicit FieldMatcher(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace mstsl
