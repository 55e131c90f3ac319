#include "field_strength.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/magnetic/field_map_builder.hpp"

#include "hand_made_survey.hpp"
#include "test_support.hpp"

namespace mstsl {
namespace {

using Eigen::Array3d;
using Eigen::Vector2d;

using test::must;

const Array3d kMean_uT(18.0, 3.0, -42.0), kSd_uT(7.0, 7.0, 7.0);

/// The definition, fingerprint by fingerprint.
double by_definition(const std::vector<Fingerprint>& survey, const Vector2d& at, double radius_m) {
  double weight = 0.1, squares = 0.1;
  for (const Fingerprint& f : survey) {
    const double w = std::exp(-0.5 * (f.position_m - at).squaredNorm() / (radius_m * radius_m));
    weight += w;
    squares += w * ((f.field_uT.array() - kMean_uT) / kSd_uT).square().mean();
  }
  return squares / weight;
}

/// Strong on the right, a tenth of it on the left.
std::vector<Fingerprint> uneven_survey(const test::WavyField& field, Random& random) {
  test::SurveyPlan plan;
  plan.width_m = 16.0;
  plan.height_m = 6.0;
  plan.lane_m = 1.2;
  plan.noise_uT = 0.05;
  auto survey = test::drive(field, plan, random);
  for (Fingerprint& f : survey)
    if (f.position_m.x() < 8.0) f.field_uT = kMean_uT.matrix() + 0.1 * (f.field_uT - kMean_uT.matrix());
  return survey;
}

TEST(FieldStrength, IsTheWeightedMeanOfItsDefinition) {
  Random random(51);
  const auto survey = uneven_survey(test::WavyField(0.6, 7.0, random), random);
  for (const double radius_m : {0.5, 1.0}) {
    const FieldStrength strength(survey, kMean_uT, kSd_uT, radius_m);
    for (int i = 0; i < 100; ++i) {
      const Vector2d at(random.uniform(0.0, 16.0), random.uniform(0.0, 6.0));
      EXPECT_NEAR(strength.at(at) / by_definition(survey, at, radius_m), 1.0, 0.25) << at.transpose();
    }
  }
}

TEST(FieldStrength, IsOneWhereNothingIsKnown) {
  Random random(52);
  const auto survey = uneven_survey(test::WavyField(0.6, 7.0, random), random);
  const FieldStrength strength(survey, kMean_uT, kSd_uT, 0.5);
  EXPECT_NEAR(strength.at({8.0, 9.0}), 1.0, 0.01);
  EXPECT_EQ(strength.at({1e9, -1e9}), 1.0);
  EXPECT_EQ(strength.at({std::nan(""), 0.0}), 1.0);
  EXPECT_EQ(FieldStrength({}, kMean_uT, kSd_uT, 0.5).at({1.0, 2.0}), 1.0);
}

TEST(FieldStrength, MakesAMapHonestInCalmAndStrongPlacesAlike) {
  Random random(53);
  const test::WavyField field(0.6, 7.0, random);
  const auto survey = uneven_survey(field, random);
  FieldMapOptions options;
  options.resolution_m = 0.1;
  options.analysis.kernel = KernelChoice::kSquaredExponential;
  const FieldMap map = must(build_field_map(survey, nullptr, options));
  double sd_uT[2] = {0, 0};
  for (const bool strong : {false, true}) {
    int within = 0, all = 0;
    for (double x = strong ? 9.0 : 1.0; x < (strong ? 15.0 : 7.0); x += 0.11)
      for (double y = 0.5; y < 5.5; y += 0.13, ++all) {
        const auto foretold = map.at({x, y});
        ASSERT_TRUE(foretold);
        const double share = strong ? 1.0 : 0.1, sd = std::sqrt(foretold->variance_uT2.x());
        const double truth = kMean_uT.x() + share * (field.at({x, y}).x() - kMean_uT.x());
        within += std::abs(foretold->mean_uT.x() - truth) < sd;
        sd_uT[strong ? 1 : 0] += sd;
      }
    EXPECT_NEAR(static_cast<double>(within) / all, 0.7, 0.2) << (strong ? "strong" : "calm");
  }
  EXPECT_LT(3.0 * sd_uT[0], sd_uT[1]);
}

}  // namespace
}  // namespace mstsl
