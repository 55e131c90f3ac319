#include "mstsl/magnetic/matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <nanoflann.hpp>

#include "distinct_places.hpp"
#include "gaussian_scores.hpp"

namespace mstsl {
namespace {

constexpr float kOutOfQuestion = -std::numeric_limits<float>::infinity();
/// Densities below exp(-25) of the best add up to nothing even over a million cells.
constexpr float kNegligible = 25.0F;

/// The places' fields as nanoflann wants to see them.
struct FieldPoints {
  const PlaceFields* fields;
  std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(fields->size()); }
  float kdtree_get_pt(std::size_t index, std::size_t component) const {
    return fields->mean_uT[component](static_cast<Eigen::Index>(index));
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using FieldTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, FieldPoints>,
                                                      FieldPoints, 3, std::size_t>;

}  // namespace

struct FieldMatcher::State {
  FieldModel model = FieldModel::kGpr;
  Threads threads;
  BinnedPlaces places;
  PlaceFields fields;
  double mean_variance_uT2 = 0.0;
  FieldPoints points{};
  std::unique_ptr<FieldTree> tree;  ///< for k-NN models

  void take(const std::vector<Eigen::Vector2d>& positions_m, const std::vector<Eigen::Vector3f>& means,
            const std::vector<Eigen::Vector3f>& variances);
  PlaceScores gaussian_scores(std::span<const FieldObservation> observations) const;
  PlaceScores nearest_scores(std::span<const FieldObservation> observations, std::size_t count) const;
};

void FieldMatcher::State::take(const std::vector<Eigen::Vector2d>& positions_m,
                               const std::vector<Eigen::Vector3f>& means,
                               const std::vector<Eigen::Vector3f>& variances) {
  std::vector<std::size_t> order;
  places = BinnedPlaces::make(positions_m, order);
  const auto n = static_cast<Eigen::Index>(order.size());
  for (std::size_t c = 0; c < 3; ++c) {
    fields.mean_uT[c].resize(n);
    fields.variance_uT2[c].resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      fields.mean_uT[c](i) = means[order[i]](static_cast<Eigen::Index>(c));
      fields.variance_uT2[c](i) = variances[order[i]](static_cast<Eigen::Index>(c));
    }
    mean_variance_uT2 += fields.variance_uT2[c].cast<double>().mean() / 3.0;
  }
}

namespace {

/// Cells with a value, for the cell models.
void list_cells(const FieldMap& map, bool supported_only, std::vector<Eigen::Vector2d>& positions_m,
                std::vector<Eigen::Vector3f>& means, std::vector<Eigen::Vector3f>& variances) {
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const Cell cell = map.geometry.cell(i);
    if (!map.has_value(cell) || (supported_only && map.supported[i] == 0)) continue;
    positions_m.push_back(map.geometry.center_of(cell));
    means.push_back(map.mean_uT[i]);
    variances.push_back(map.variance_uT2[i]);
  }
}

/// The fingerprints themselves, with the variance that the map gives their cells.
void list_fingerprints(const FieldMap& map, std::vector<Eigen::Vector2d>& positions_m,
                       std::vector<Eigen::Vector3f>& means, std::vector<Eigen::Vector3f>& variances) {
  for (const Fingerprint& f : map.fingerprints) {
    const Cell cell = map.geometry.cell_at(f.position_m);
    positions_m.push_back(f.position_m);
    means.push_back(f.field_uT.cast<float>());
    variances.push_back(map.has_value(cell) ? map.variance_uT2[map.geometry.index(cell)]
                                            : Eigen::Vector3f::Ones().eval());
  }
}

}  // namespace

Result<FieldMatcher> FieldMatcher::make(const FieldMap& map, const MatcherOptions& options) {
  std::vector<Eigen::Vector2d> positions_m;
  std::vector<Eigen::Vector3f> means, variances;
  if (map.model == FieldModel::kFingerprint)
    list_fingerprints(map, positions_m, means, variances);
  else
    list_cells(map, options.supported_only, positions_m, means, variances);
  if (positions_m.empty())
    return Error(
        "the field map has no cell or fingerprint to compare a measurement with; survey the place again");
  auto state = std::make_unique<State>();
  state->model = map.model;
  state->threads = options.threads;
  state->take(positions_m, means, variances);
  if (map.model != FieldModel::kGpr) {
    state->points.fields = &state->fields;
    state->tree =
        std::make_unique<FieldTree>(3, state->points, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    state->tree->buildIndex();
  }
  return FieldMatcher(std::move(state));
}

FieldMatcher::FieldMatcher(std::unique_ptr<State> state) : state_(std::move(state)) {}
FieldMatcher::FieldMatcher(FieldMatcher&&) noexcept = default;
FieldMatcher& FieldMatcher::operator=(FieldMatcher&&) noexcept = default;
FieldMatcher::~FieldMatcher() = default;

std::size_t FieldMatcher::size() const { return state_->places.positions_m.size(); }
Eigen::Vector2d FieldMatcher::position_m(std::size_t place) const {
  return state_->places.positions_m[place];
}

std::vector<float> FieldMatcher::log_densities(const FieldObservation& observation) const {
  return gaussian_log_densities(state_->fields, observation, state_->threads);
}

std::vector<FieldMatcher::Neighbour> FieldMatcher::nearest(const Eigen::Vector3d& field_uT,
                                                           std::size_t count) const {
  count = std::min(count, size());
  std::vector<Neighbour> neighbours(count);
  if (state_->tree) {
    const Eigen::Vector3f query = field_uT.cast<float>();
    std::vector<std::size_t> indices(count);
    std::vector<float> squares(count);
    state_->tree->knnSearch(query.data(), count, indices.data(), squares.data());
    for (std::size_t i = 0; i < count; ++i)
      neighbours[i] = {indices[i], std::sqrt(static_cast<double>(squares[i]))};
    return neighbours;
  }
  std::vector<Neighbour> all(size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    double square = 0.0;
    for (int c = 0; c < 3; ++c)
      square += std::pow(static_cast<double>(state_->fields.mean_uT[static_cast<std::size_t>(c)](
                             static_cast<Eigen::Index>(i))) -
                             field_uT(c),
                         2);
    all[i] = {i, std::sqrt(square)};
  }
  std::partial_sort_copy(all.begin(), all.end(), neighbours.begin(), neighbours.end(),
                         [](const Neighbour& a, const Neighbour& b) {
                           return std::pair(a.distance_uT, a.place) < std::pair(b.distance_uT, b.place);
                         });
  return neighbours;
}

/// Adds up what several observations say of one place after the other.
PlaceScores FieldMatcher::State::gaussian_scores(std::span<const FieldObservation> observations) const {
  const std::size_t n = places.positions_m.size();
  PlaceScores scores{std::vector<float>(n, kOutOfQuestion), std::vector<std::uint16_t>(n, 0),
                     std::vector<float>(n, 0.0F)};
  std::vector<std::vector<float>> each;
  for (const FieldObservation& observation : observations) {
    each.push_back(gaussian_log_densities(fields, observation, threads));
    for (std::size_t i = 0; i < n; ++i)
      if (each.back()[i] > scores.log_density[i]) {
        scores.log_density[i] = each.back()[i];
        scores.observation[i] = static_cast<std::uint16_t>(each.size() - 1);
      }
  }
  const float best = n > 0 ? *std::max_element(scores.log_density.begin(), scores.log_density.end()) : 0.0F;
  for (const auto& log_density : each)
    for (std::size_t i = 0; i < n; ++i)
      if (log_density[i] > best - kNegligible) scores.mass[i] += std::exp(log_density[i] - best);
  return scores;
}

/// The same from the `count` nearest places of each observation; all others are out of the question.
PlaceScores FieldMatcher::State::nearest_scores(std::span<const FieldObservation> observations,
                                                std::size_t count) const {
  const std::size_t n = places.positions_m.size();
  PlaceScores scores{std::vector<float>(n, kOutOfQuestion), std::vector<std::uint16_t>(n, 0),
                     std::vector<float>(n, 0.0F)};
  count = std::min(count, n);
  std::vector<std::vector<std::size_t>> indices(observations.size(), std::vector<std::size_t>(count));
  std::vector<std::vector<float>> log_densities(observations.size(), std::vector<float>(count));
  float best = kOutOfQuestion;
  for (std::size_t o = 0; o < observations.size(); ++o) {
    const Eigen::Vector3f query = observations[o].field_uT.cast<float>();
    const auto variance =
        static_cast<float>(observations[o].covariance_uT2.trace() / 3.0 + mean_variance_uT2);
    tree->knnSearch(query.data(), count, indices[o].data(),
                    log_densities[o].data());  // squared distances so far
    for (float& value : log_densities[o]) best = std::max(best, value = -0.5F * value / variance);
  }
  for (std::size_t o = 0; o < observations.size(); ++o)
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = indices[o][k];
      scores.mass[i] += std::exp(log_densities[o][k] - best);
      if (log_densities[o][k] > scores.log_density[i]) {
        scores.log_density[i] = log_densities[o][k];
        scores.observation[i] = static_cast<std::uint16_t>(o);
      }
    }
  return scores;
}

std::vector<LocationCandidate> FieldMatcher::locate(std::span<const FieldObservation> observations,
                                                    const DistinctOptions& options) const {
  if (!state_->tree) return select_distinct(state_->places, state_->gaussian_scores(observations), options);
  // The nearest neighbours in field space crowd at few places: ask for more until enough of them are
  // distinct.
  for (std::size_t count = 16 * options.count;; count *= 4) {
    auto candidates = select_distinct(state_->places, state_->nearest_scores(observations, count), options);
    if (candidates.size() >= options.count || count >= size()) return candidates;
  }
}

}  // namespace mstsl
