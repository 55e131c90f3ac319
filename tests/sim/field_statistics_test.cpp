#include "field_statistics.hpp"

#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "test_support.hpp"

/// Simulated fields against recorded ones. The bounds are those of real buildings (cea-corridor,
/// aalto-robot), never of what a localizer would like.
namespace mstsl::test {
namespace {

double rms(const Eigen::Vector3d& sd) { return std::sqrt(sd.squaredNorm() / 3.0); }

FieldStatistics measure(const std::string& name) {
  std::vector<FieldPath> all;
  // Two buildings where one is small and may be odd; the large ones are many places in themselves.
  for (const std::uint64_t seed : {11, 12}) {
    std::vector<FieldPath> paths = survey_paths(must(sim::make_world(name, {}, Random(seed))));
    for (FieldPath& path : paths)
      for (FieldSample& sample : path)
        sample.position_m.x() += 1e4 * static_cast<double>(seed);  // one beside the other
    std::move(paths.begin(), paths.end(), std::back_inserter(all));
    if (name != "corridor" && name != "office-wing") break;
  }
  return statistics(all);
}

/// Measured once for all tests.
const FieldStatistics& of_world(const std::string& name) {
  static std::map<std::string, FieldStatistics> known;
  const auto found = known.find(name);
  return found != known.end() ? found->second : known.emplace(name, measure(name)).first->second;
}

class FieldOfWorld : public ::testing::TestWithParam<std::string> {};

TEST_P(FieldOfWorld, SpreadsAndChangesAsInRealBuildings) {
  const FieldStatistics s = of_world(GetParam());
  RecordProperty("sd_uT", std::to_string(rms(s.sd_uT)));
  EXPECT_GT(rms(s.sd_uT), 5.0);
  EXPECT_LT(rms(s.sd_uT), 13.0);
  for (const double sd : s.sd_uT) {
    EXPECT_GT(sd, 3.0);
    EXPECT_LT(sd, 15.0);
  }
  EXPECT_GT(s.along_m, 0.4);
  EXPECT_LT(s.along_m, 3.0);
  // Real: 0.45 (near the floor) to 0.94 (corridors).
  EXPECT_GT(s.along_at_half_m, 0.45);
  EXPECT_LT(s.along_at_half_m, 0.95);
  EXPECT_GT(s.across_at_half_m, 0.4);
  EXPECT_LT(s.across_at_half_m, 0.95);
}

TEST_P(FieldOfWorld, HasQuietAndStrongPlacesAsRealBuildingsHave) {
  const FieldStatistics s = of_world(GetParam());
  // Real: kurtosis 2.8 and 5.9; median gradient 8 and 35 uT/m, 95 % at 17 and 107.
  EXPECT_GT(s.kurtosis, 2.5);
  EXPECT_LT(s.kurtosis, 20.0);
  EXPECT_GT(s.gradient_uT_m[1], 3.0);
  EXPECT_LT(s.gradient_uT_m[1], 35.0);
  EXPECT_GT(s.gradient_uT_m[2], 10.0);
  EXPECT_LT(s.gradient_uT_m[2], 107.0);
  EXPECT_LT(2.0 * s.local_sd_low_uT, s.local_sd_high_uT);
}

INSTANTIATE_TEST_SUITE_P(Every, FieldOfWorld,
                         ::testing::Values("corridor", "carpark", "warehouse", "office-wing"),
                         [](const auto& test) {
                           return test.param == "office-wing" ? std::string("office_wing") : test.param;
                         });

TEST(RealCorridor, IsMeasuredAsItsDescriptionSays) {
  MSTSL_REQUIRE_DATA("cea-corridor/floor_a_survey.csv");
  const FieldStatistics s = statistics({read_cea(data_file("cea-corridor/floor_a_survey.csv").string())});
  EXPECT_NEAR(rms(s.sd_uT), 7.6, 0.2);
  EXPECT_NEAR(s.along_m, 2.0, 0.1);
  EXPECT_NEAR(s.gradient_uT_m[1], 8.7, 0.2);
}

TEST(RealCorridor, IsLikeTheSimulatedOne) {
  MSTSL_REQUIRE_DATA("cea-corridor/floor_a_survey.csv");
  const FieldStatistics real = statistics({read_cea(data_file("cea-corridor/floor_a_survey.csv").string())});
  const FieldStatistics made = of_world("corridor");
  const auto within = [](double a, double b, double factor) { return a < factor * b && b < factor * a; };
  EXPECT_TRUE(within(rms(made.sd_uT), rms(real.sd_uT), 1.4)) << rms(made.sd_uT);
  EXPECT_TRUE(within(made.along_m, real.along_m, 1.6)) << made.along_m;
  EXPECT_TRUE(within(made.gradient_uT_m[1], real.gradient_uT_m[1], 1.7)) << made.gradient_uT_m[1];
  EXPECT_TRUE(within(made.gradient_uT_m[2], real.gradient_uT_m[2], 1.7)) << made.gradient_uT_m[2];
  EXPECT_TRUE(within(made.local_sd_low_uT, real.local_sd_low_uT, 2.0)) << made.local_sd_low_uT;
  EXPECT_TRUE(within(made.local_sd_high_uT, real.local_sd_high_uT, 1.5)) << made.local_sd_high_uT;
}

}  // namespace
}  // namespace mstsl::test
