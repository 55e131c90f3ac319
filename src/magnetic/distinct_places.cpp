#include "distinct_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "point_bins.hpp"

namespace mstsl {
namespace {

using Eigen::Vector2d;
using Bin = BinnedPlaces::Bin;

constexpr double kBin_m = 1.0;
constexpr float kNothing = -std::numeric_limits<float>::infinity();

bool touches(const Bin& bin, const Vector2d& center_m, double radius_m) {
  const Vector2d nearest = center_m.cwiseMax(bin.low_m).cwiseMin(bin.high_m);
  return (nearest - center_m).squaredNorm() < radius_m * radius_m;
}

/// Works through the places with one flag each for "already belongs to a candidate".
class Selection {
 public:
  Selection(const BinnedPlaces& places, const PlaceScores& scores, const DistinctOptions& options)
      : places_(places),
        scores_(scores),
        options_(options),
        taken_(places.positions_m.size(), 0),
        best_(places.bins.size()) {
    for (std::size_t b = 0; b < best_.size(); ++b) best_[b] = best_in(places.bins[b]);
    for (const float mass : scores.mass) total_mass_ += mass;
  }

  std::vector<LocationCandidate> run() {
    std::vector<LocationCandidate> candidates;
    while (candidates.size() < options_.count) {
      const std::size_t peak = options_.rank == CandidateRank::kPeak ? highest_peak() : heaviest_disc();
      if (peak == kNone) break;
      candidates.push_back(take(peak));
    }
    return candidates;
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// The free place with the highest density in a bin.
  std::size_t best_in(const Bin& bin) const {
    std::size_t best = kNone;
    float density = kNothing;
    for (std::size_t i = bin.first; i < bin.last; ++i)
      if (taken_[i] == 0 && scores_.log_density[i] > density) density = scores_.log_density[best = i];
    return best;
  }

  std::size_t highest_peak() const {
    std::size_t best = kNone;
    for (const std::size_t i : best_)
      if (i != kNone && (best == kNone || scores_.log_density[i] > scores_.log_density[best])) best = i;
    return best;
  }

  /// Of the best places of all bins, the one with the most free mass around it.
  std::size_t heaviest_disc() const {
    std::size_t heaviest = kNone;
    double most = -1.0;
    for (const std::size_t i : best_) {
      if (i == kNone) continue;
      const double mass = free_mass(places_.positions_m[i]);
      if (mass > most) {
        most = mass;
        heaviest = i;
      }
    }
    return heaviest;
  }

  template <typename Visit>
  void for_each_free(const Vector2d& center_m, const Visit& visit) const {
    const double radius2 = options_.separation_m * options_.separation_m;
    for (const Bin& bin : places_.bins) {
      if (!touches(bin, center_m, options_.separation_m)) continue;
      for (std::size_t i = bin.first; i < bin.last; ++i)
        if (taken_[i] == 0 && (places_.positions_m[i] - center_m).squaredNorm() < radius2) visit(i);
    }
  }

  double free_mass(const Vector2d& center_m) const {
    double sum = 0.0;
    for_each_free(center_m, [&](std::size_t i) { sum += scores_.mass[i]; });
    return sum;
  }

  /// Makes a candidate of a place and all that is free around it.
  LocationCandidate take(std::size_t peak) {
    LocationCandidate candidate;
    candidate.position_m = places_.positions_m[peak];
    candidate.log_density = scores_.log_density[peak];
    candidate.observation = scores_.observation[peak];
    constexpr double kLeastSd_m = 0.05;  // a place stands for the 5 cm around it
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    double mass = 0.0;
    std::vector<std::size_t> around;
    for_each_free(candidate.position_m, [&](std::size_t i) {
      const Vector2d offset = places_.positions_m[i] - candidate.position_m;
      spread += scores_.mass[i] * offset * offset.transpose();
      mass += scores_.mass[i];
      around.push_back(i);
    });
    candidate.covariance_m2 = Eigen::Matrix2d::Identity() * kLeastSd_m * kLeastSd_m;
    if (mass > 0.0) candidate.covariance_m2 += spread / mass;
    candidate.probability = total_mass_ > 0.0 ? mass / total_mass_ : 0.0;
    for (const std::size_t i : around) taken_[i] = 1;
    taken_[peak] = 1;
    for (std::size_t b = 0; b < best_.size(); ++b)
      if (touches(places_.bins[b], candidate.position_m, options_.separation_m))
        best_[b] = best_in(places_.bins[b]);
    return candidate;
  }

  const BinnedPlaces& places_;
  const PlaceScores& scores_;
  DistinctOptions options_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::size_t> best_;  ///< per bin
  double total_mass_ = 0.0;
};

}  // namespace

BinnedPlaces BinnedPlaces::make(std::span<const Vector2d> points_m, std::vector<std::size_t>& order) {
  BinnedPlaces places;
  order.clear();
  for (const auto& indices : PointBins(points_m, kBin_m).occupied()) {
    Bin bin{order.size(), order.size() + indices.size(), points_m[indices[0]], points_m[indices[0]]};
    for (const std::size_t i : indices) {
      bin.low_m = bin.low_m.cwiseMin(points_m[i]);
      bin.high_m = bin.high_m.cwiseMax(points_m[i]);
      order.push_back(i);
      places.positions_m.push_back(points_m[i]);
    }
    places.bins.push_back(bin);
  }
  return places;
}

std::vector<LocationCandidate> select_distinct(const BinnedPlaces& places, const PlaceScores& scores,
                                               const DistinctOptions& options) {
  return Selection(places, scores, options).run();
}

}  // namespace mstsl
