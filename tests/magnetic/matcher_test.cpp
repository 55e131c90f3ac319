#include "mstsl/magnetic/matcher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;

Eigen::Vector3d field_at(const Eigen::Vector2d& p) {
  return {20 + 7 * std::sin(1.3 * p.x() + 0.2) * std::cos(0.9 * p.y()),
          6 * std::cos(1.1 * p.y() + 0.5 * p.x()), -40 + 8 * std::sin(0.7 * p.x() - 1.2 * p.y())};
}

/// Cells of 10 cm over 12 x 6 m with varying variance, a hole without values and a corner without support.
FieldMap some_map(FieldModel model) {
  FieldMap map;
  map.model = model;
  map.geometry = {0.1, 120, 60, Pose2{-3.0, 2.0, 0.3}};
  Random random(1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const Cell cell = map.geometry.cell(i);
    const Eigen::Vector2d p = map.geometry.center_of(cell);
    const bool hole = cell.column > 50 && cell.column < 60 && cell.row > 20 && cell.row < 30;
    const float variance = 0.2F + 0.5F * static_cast<float>(random.uniform());
    map.mean_uT.push_back(hole ? Eigen::Vector3f::Constant(nan) : Eigen::Vector3f(field_at(p).cast<float>()));
    map.variance_uT2.push_back(hole ? Eigen::Vector3f::Constant(nan)
                                    : Eigen::Vector3f(variance, 2 * variance, 0.5F * variance));
    map.supported.push_back(hole || (cell.column < 10 && cell.row < 10) ? 0 : 1);
    if (!hole && i % 7 == 0) map.fingerprints.push_back({p, field_at(p), 0.0, 0});
  }
  return map;
}

FieldObservation observation(const Eigen::Vector3d& field_uT) {
  FieldObservation o{field_uT, Eigen::Matrix3d::Identity() * 0.3};
  o.covariance_uT2(0, 1) = o.covariance_uT2(1, 0) = 0.1;
  o.covariance_uT2(1, 2) = o.covariance_uT2(2, 1) = -0.15;
  return o;
}

double direct_log_density(const FieldMap& map, std::size_t cell, const FieldObservation& o) {
  const Eigen::Vector3d r = o.field_uT - map.mean_uT[cell].cast<double>();
  const Eigen::Matrix3d s =
      o.covariance_uT2 + Eigen::Matrix3d(map.variance_uT2[cell].cast<double>().asDiagonal());
  return -0.5 *
         (r.dot(s.inverse() * r) + std::log(s.determinant()) + 3 * std::log(2 * 3.14159265358979323846));
}

TEST(FieldMatcher, ItsDensityIsTheMultivariateGaussianOfEveryUsableCell) {
  const FieldMap map = some_map(FieldModel::kGpr);
  const FieldMatcher matcher = must(FieldMatcher::make(map));
  const FieldObservation o = observation({24, 3, -36});
  const auto densities = matcher.log_densities(o);
  std::size_t usable = 0;
  for (const auto supported : map.supported) usable += supported;
  ASSERT_EQ(densities.size(), usable);
  for (std::size_t i = 0; i < densities.size(); ++i) {
    const Cell cell = map.geometry.cell_at(matcher.position_m(i));
    const double direct = direct_log_density(map, map.geometry.index(cell), o);
    EXPECT_NEAR(densities[i], direct, 1e-5 * (1 + std::abs(direct)));
  }
}

TEST(FieldMatcher, OneThreadAndFourGiveTheSameBits) {
  const FieldMap map = some_map(FieldModel::kGpr);
  const FieldObservation o = observation({24, 3, -36});
  EXPECT_EQ(must(FieldMatcher::make(map, {true, {1}})).log_densities(o),
            must(FieldMatcher::make(map, {true, {4}})).log_densities(o));
}

TEST(FieldMatcher, NearestNeighboursAreThoseOfALookAtEveryPlace) {
  for (const FieldModel model : {FieldModel::kGpr, FieldModel::kBilinear, FieldModel::kFingerprint}) {
    const FieldMap map = some_map(model);
    const FieldMatcher matcher = must(FieldMatcher::make(map));
    const Eigen::Vector3d query(22, -2, -39);
    std::vector<double> all;
    for (std::size_t i = 0; i < matcher.size(); ++i)
      all.push_back((field_at(matcher.position_m(i)) - query).norm());
    std::sort(all.begin(), all.end());
    const auto found = matcher.nearest(query, 50);
    ASSERT_EQ(found.size(), 50u);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k].distance_uT, all[k], 1e-4);
      EXPECT_NEAR((field_at(matcher.position_m(found[k].place)) - query).norm(), found[k].distance_uT, 1e-4);
    }
    EXPECT_EQ(matcher.nearest(query, 10 * matcher.size()).size(), matcher.size());
  }
}

/// Non-maximum suppression as one would write it first: sort everything, take what is far from all taken.
std::vector<Eigen::Vector2d> plain_suppression(const FieldMatcher& matcher, const std::vector<float>& scores,
                                               const DistinctOptions& options) {
  std::vector<std::size_t> order(scores.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
  std::vector<Eigen::Vector2d> taken;
  for (const std::size_t i : order) {
    const Eigen::Vector2d p = matcher.position_m(i);
    const bool near = std::any_of(taken.begin(), taken.end(),
                                  [&](const auto& t) { return (t - p).norm() < options.separation_m; });
    if (!near && taken.size() < options.count) taken.push_back(p);
  }
  return taken;
}

TEST(FieldMatcher, TheCandidatesAreThoseOfPlainNonMaximumSuppression) {
  Random random(3);
  const FieldMatcher matcher = must(FieldMatcher::make(some_map(FieldModel::kGpr)));
  for (int trial = 0; trial < 20; ++trial) {
    const DistinctOptions options{static_cast<std::size_t>(1 + trial % 9), random.uniform(0.2, 3.0),
                                  CandidateRank::kPeak};
    const FieldObservation o = observation(field_at({random.uniform(-2, 8), random.uniform(3, 8)}));
    const auto expected = plain_suppression(matcher, matcher.log_densities(o), options);
    const auto found = matcher.locate(std::vector{o}, options);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k].position_m, expected[k]);
  }
}

TEST(FieldMatcher, ForKnnTooTheCandidatesAreThoseOfPlainSuppression) {
  Random random(4);
  for (const FieldModel model : {FieldModel::kBilinear, FieldModel::kFingerprint}) {
    const FieldMatcher matcher = must(FieldMatcher::make(some_map(model)));
    for (int trial = 0; trial < 10; ++trial) {
      const DistinctOptions options{8, random.uniform(0.5, 2.0), CandidateRank::kPeak};
      const Eigen::Vector3d query =
          field_at({random.uniform(-2, 8), random.uniform(3, 8)}) + Eigen::Vector3d(0.1, 0, 0.2);
      std::vector<float> scores;
      for (std::size_t i = 0; i < matcher.size(); ++i)
        scores.push_back(
            -(field_at(matcher.position_m(i)).cast<float>() - query.cast<float>()).squaredNorm());
      const auto expected = plain_suppression(matcher, scores, options);
      const auto found = matcher.locate(std::vector{observation(query)}, options);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_LT((found[k].position_m - expected[k]).norm(), 1e-9);
    }
  }
}

TEST(FieldMatcher, ProbabilitiesAreSharesOfThePosterior) {
  const FieldMap map = some_map(FieldModel::kGpr);
  const FieldMatcher matcher = must(FieldMatcher::make(map));
  const FieldObservation o = observation(field_at({1.0, 5.0}));
  const auto densities = matcher.log_densities(o);
  const auto found = matcher.locate(std::vector{o}, {4, 1.0, CandidateRank::kPeak});
  double total = 0.0, first = 0.0;
  for (std::size_t i = 0; i < densities.size(); ++i) {
    total += std::exp(densities[i]);
    if ((matcher.position_m(i) - found[0].position_m).norm() < 1.0) first += std::exp(densities[i]);
  }
  EXPECT_NEAR(found[0].probability, first / total, 1e-5);
  double sum = 0.0;
  for (const auto& c :
       must(FieldMatcher::make(map)).locate(std::vector{o}, {1000, 1.0, CandidateRank::kPeak}))
    sum += c.probability;
  EXPECT_NEAR(sum, 1.0, 1e-5);  // every place belongs to some candidate, once
}

TEST(FieldMatcher, OfSeveralObservationsTheCandidateNamesTheOneThatFits) {
  const FieldMatcher matcher = must(FieldMatcher::make(some_map(FieldModel::kGpr)));
  const Eigen::Vector2d place(1.0, 5.0);
  const std::vector<FieldObservation> turned{observation({-90, 0, 0}), observation({0, -90, 0}),
                                             observation(field_at(place))};
  const auto found = matcher.locate(turned, {1, 1.0, CandidateRank::kPeak});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].observation, 2u);
  EXPECT_LT((field_at(found[0].position_m) - field_at(place)).norm(), 2.0);
  EXPECT_GT(found[0].covariance_m2.determinant(), 0.0);
}

TEST(FieldMatcher, RankedByMassTheFirstCandidateHoldsMostProbability) {
  const FieldMatcher matcher = must(FieldMatcher::make(some_map(FieldModel::kGpr)));
  const auto found = matcher.locate(std::vector{observation({20, 1, -38})}, {6, 1.0, CandidateRank::kMass});
  for (std::size_t k = 1; k < found.size(); ++k) EXPECT_LE(found[k].probability, found[k - 1].probability);
}

TEST(FieldMatcher, AMeasurementFarFromEverythingStillRanksThePlaces) {
  for (const FieldModel model : {FieldModel::kGpr, FieldModel::kBilinear}) {
    const auto found = must(FieldMatcher::make(some_map(model)))
                           .locate(std::vector{observation({900, 0, 0})}, {3, 1.0, CandidateRank::kPeak});
    ASSERT_EQ(found.size(), 3u);
    EXPECT_GT(found[0].probability, 0.0);
    for (const auto& c : found) EXPECT_TRUE(std::isfinite(c.log_density) && c.covariance_m2.allFinite());
  }
}

TEST(FieldMatcher, AMapWithoutAUsableCellIsAnError) {
  FieldMap map = some_map(FieldModel::kGpr);
  std::fill(map.supported.begin(), map.supported.end(), std::uint8_t{0});
  EXPECT_FALSE(FieldMatcher::make(map).ok());
  EXPECT_TRUE(FieldMatcher::make(map, {false, {}}).ok());
}

}  // namespace
}  // namespace mstsl
