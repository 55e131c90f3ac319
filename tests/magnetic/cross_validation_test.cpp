#include "mstsl/magnetic/cross_validation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/magnetic/predictors.hpp"

#include "hand_made_survey.hpp"

namespace mstsl {
namespace {

using test::drive;
using test::WavyField;

std::vector<Fingerprint> a_survey() {
  Random random(31);
  const WavyField field(0.6, 7.0, random);
  return drive(field, {8.0, 4.0, 0.5}, random);
}

double nearest_m(const std::vector<Fingerprint>& survey, std::size_t tested,
                 const std::vector<std::size_t>& training) {
  double nearest = 1e9;
  for (const std::size_t i : training)
    nearest = std::min(nearest, (survey[i].position_m - survey[tested].position_m).norm());
  return nearest;
}

TEST(HoldOutLanes, TrainsOnNothingOfItsOwnPass) {
  const auto survey = a_survey();
  HoldOutOptions options;
  options.length_m = 0.6;
  const auto stretches = hold_out_lanes(survey, options);
  ASSERT_GT(stretches.size(), 10u);
  for (const HeldOutStretch& s : stretches)
    for (const std::size_t tested : s.tested)
      for (const std::size_t i : s.training) {
        // A pass is 8 m of 5 cm steps with one heading: neighbours in the drive are not in the training.
        const bool same_pass = survey[i].heading_rad == survey[tested].heading_rad &&
                               std::abs(survey[i].position_m.y() - survey[tested].position_m.y()) < 1e-9;
        EXPECT_FALSE(same_pass);
      }
}

TEST(HoldOutLanes, KeepsTheRadiusClear) {
  const auto survey = a_survey();
  HoldOutOptions options;
  options.length_m = 0.6;
  options.radius_m = 0.3;
  for (const HeldOutStretch& s : hold_out_lanes(survey, options))
    for (const std::size_t tested : s.tested) EXPECT_GE(nearest_m(survey, tested, s.training), 0.3);
}

TEST(HoldOutLanes, WithoutTheRadiusTheOtherWayOfTheSameLaneIsThere) {
  const auto survey = a_survey();
  HoldOutOptions options;
  options.length_m = 0.6;
  for (const HeldOutStretch& s : hold_out_lanes(survey, options))
    EXPECT_LT(nearest_m(survey, s.tested[s.tested.size() / 2], s.training), 0.15);
}

TEST(HoldOutLanes, ASinglePassLeavesNothingToLearnFrom) {
  Random random(32);
  const WavyField field(0.6, 7.0, random);
  auto survey = drive(field, {8.0, 0.0}, random);
  survey.resize(survey.size() / 2);
  EXPECT_TRUE(hold_out_lanes(survey, {}).empty());
}

TEST(HeldOutErrors, AreThoseOfThePredictor) {
  const auto survey = a_survey();
  const auto stretches = hold_out_lanes(survey, {});
  const Predictor constant = [](std::span<const Fingerprint>, std::span<const Eigen::Vector2d> points) {
    return std::vector<std::optional<FieldPrediction>>(
        points.size(), FieldPrediction{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 5, 6)});
  };
  const auto errors = held_out_errors(survey, stretches, constant, {3});
  std::size_t k = 0;
  for (const HeldOutStretch& s : stretches)
    for (const std::size_t tested : s.tested) {
      ASSERT_LT(k, errors.size());
      EXPECT_EQ(errors[k].error_uT.matrix(), survey[tested].field_uT - Eigen::Vector3d(1, 2, 3));
      EXPECT_EQ(errors[k++].variance_uT2.z(), 6.0);
    }
  EXPECT_EQ(k, errors.size());
}

}  // namespace
}  // namespace mstsl
