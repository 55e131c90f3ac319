#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "mstsl/datasets/kaist.hpp"
#include "mstsl/datasets/path_field.hpp"
#include "mstsl/datasets/windows.hpp"

namespace mstsl::datasets {
namespace {

/// Surveyed points this near to the walk were walked over: the next line of points is farther.
constexpr double kBeside_m = 0.3;
/// Rows of a walker who has not moved this far say nothing new.
constexpr double kStep_m = 0.05;
/// A row farther than this from the nearest point walked over lies beyond the survey's ends.
constexpr double kReach_m = 0.5;

struct Pairs {
  std::vector<Eigen::Vector3d> phone_uT;
  std::vector<Eigen::Vector3d> survey_uT;
};

double squared_distance(const Fingerprint& a, const Fingerprint& b) {
  return (a.position_m - b.position_m).squaredNorm();
}

std::size_t nearest(std::span<const Fingerprint> points, const Fingerprint& to) {
  return static_cast<std::size_t>(std::min_element(points.begin(), points.end(),
                                                   [&](const auto& a, const auto& b) {
                                                     return squared_distance(a, to) < squared_distance(b, to);
                                                   }) -
                                  points.begin());
}

/// The surveyed points that were walked over, in the order of the walk.
std::vector<Fingerprint> points_beside(std::span<const Fingerprint> walk,
                                       std::span<const Fingerprint> survey) {
  std::vector<std::pair<std::size_t, Fingerprint>> passed;
  for (const Fingerprint& point : survey) {
    const std::size_t row = nearest(walk, point);
    if (squared_distance(walk[row], point) <= kBeside_m * kBeside_m) passed.emplace_back(row, point);
  }
  std::stable_sort(passed.begin(), passed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Fingerprint> points;
  for (auto& [row, point] : passed) points.push_back(std::move(point));
  return points;
}

Pairs paired(std::span<const Fingerprint> rows, const PathField& surveyed) {
  Pairs pairs;
  std::optional<Fingerprint> last;
  for (const Fingerprint& row : rows) {
    if (last && squared_distance(row, *last) < kStep_m * kStep_m) continue;
    if (squared_distance(surveyed.rows()[nearest(surveyed.rows(), row)], row) > kReach_m * kReach_m) continue;
    last = row;
    pairs.phone_uT.push_back(row.field_uT);
    pairs.survey_uT.push_back(surveyed.field_uT(row.position_m));
  }
  return pairs;
}

std::size_t row_half_way(std::span<const Fingerprint> walk) {
  std::vector<Eigen::Vector2d> path_m;
  for (const Fingerprint& row : walk) path_m.push_back(row.position_m);
  const std::vector<double> along_m = distances_along(path_m);
  return static_cast<std::size_t>(std::lower_bound(along_m.begin(), along_m.end(), along_m.back() / 2.0) -
                                  along_m.begin());
}

}  // namespace

Result<std::array<WalkHalf, 2>> calibrated_halves(std::span<const Fingerprint> walk,
                                                  std::span<const Fingerprint> survey) {
  if (walk.empty() || survey.empty())
    return Error("a walk and a survey are needed, and one of them is empty");
  std::vector<Fingerprint> beside = points_beside(walk, survey);
  if (beside.empty()) return Error("the walk passes no surveyed point; are both in the same frame?");
  const PathField surveyed(std::move(beside));

  const std::size_t middle = row_half_way(walk);
  const std::array<std::span<const Fingerprint>, 2> rows = {walk.first(middle), walk.subspan(middle)};
  std::array<WalkHalf, 2> halves;
  std::array<Pairs, 2> pairs;
  for (std::size_t i = 0; i < 2; ++i) {
    halves[i].rows.assign(rows[i].begin(), rows[i].end());
    pairs[i] = paired(rows[i], surveyed);
    const Result<RotationFit> fit = fit_rotation(pairs[i].phone_uT, pairs[i].survey_uT);
    if (!fit) return fit.error().within(i == 0 ? "first half of the walk" : "second half of the walk");
    halves[i].fit = *fit;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    halves[i].survey_R_phone = halves[1 - i].fit.to_R_from;
    halves[i].residual_uT = residual_rms(halves[i].survey_R_phone, pairs[i].phone_uT, pairs[i].survey_uT);
  }
  return halves;
}

}  // namespace mstsl::datasets
