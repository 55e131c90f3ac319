#include "mstsl/localize/initialise.hpp"

#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "hand_made_world.hpp"

namespace mstsl {
namespace {

/// What a robot at `pose`, turned by `residual` off the building's axes, has read and aligned.
AlignedReading reading_at(const test::HandMadeWorld& world, const Pose2& pose, double residual_rad,
                          const Eigen::Isometry3d& base_T_magnetometer) {
  const FieldReading read = world.field_at({}, pose, base_T_magnetometer);
  AlignedReading reading;
  reading.aligned_yaw_rad = residual_rad;
  reading.field_uT = Eigen::AngleAxisd(residual_rad, Eigen::Vector3d::UnitZ()) *
                     Eigen::Vector3d(base_T_magnetometer.linear() * read.sensor_field_uT);
  reading.readings = 1;
  return reading;
}

const InitialHypothesis& nearest_to(const std::vector<InitialHypothesis>& hypotheses, const Pose2& pose) {
  return *std::min_element(hypotheses.begin(), hypotheses.end(), [&](const auto& a, const auto& b) {
    return distance(a.map_T_base, pose) < distance(b.map_T_base, pose);
  });
}

TEST(Initialise, FindsThePlaceAndTheHeadingInAllFourDirections) {
  const test::HandMadeWorld world;
  for (const double heading_deg : {0.0, 90.0, 180.0, -90.0})
    for (const double residual_deg : {0.0, 25.0, -60.0}) {
      const Pose2 pose{5.2, 1.1, radians(heading_deg + residual_deg)};
      const auto hypotheses =
          initialise(*world.maps->field, world.maps->building_axis_rad,
                     reading_at(world, pose, radians(residual_deg), Eigen::Isometry3d::Identity()),
                     Eigen::Isometry3d::Identity(), {});
      ASSERT_FALSE(hypotheses.empty());
      const Pose2 found = nearest_to(hypotheses, pose).map_T_base;
      EXPECT_LT(distance(found, pose), 0.3) << heading_deg << " deg, residual " << residual_deg;
      EXPECT_LT(std::abs(angle_between(found.yaw, pose.yaw)), radians(0.2));
    }
}

TEST(Initialise, TakesTheLeverArmOfTheMagnetometerOff) {
  const test::HandMadeWorld world;
  Eigen::Isometry3d mounting = Eigen::Isometry3d::Identity();
  mounting.translation() << 0.35, 0.2, 0.5;
  const Pose2 pose{22.8, 5.0, radians(90)};
  InitialiseOptions options;
  options.distinct.count = 20;  // more than five places have this reading; which come first is not the point
  const auto hypotheses = initialise(*world.maps->field, world.maps->building_axis_rad,
                                     reading_at(world, pose, 0.0, mounting), mounting, options);
  EXPECT_LT(distance(nearest_to(hypotheses, pose).map_T_base, pose), 0.2);
}

TEST(Initialise, ATiltedMagnetometerGivesTheSameHypotheses) {
  const test::HandMadeWorld world;
  const Pose2 pose{12.0, 9.0, radians(180)};
  Eigen::Isometry3d tilted = Eigen::Isometry3d::Identity();
  tilted.linear() =
      (Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const auto from = [&](const Eigen::Isometry3d& mounting) {
    return initialise(*world.maps->field, world.maps->building_axis_rad,
                      reading_at(world, pose, 0.1, mounting), mounting, {});
  };
  const auto upright = from(Eigen::Isometry3d::Identity()), leaning = from(tilted);
  ASSERT_EQ(upright.size(), leaning.size());
  for (std::size_t i = 0; i < upright.size(); ++i) {
    EXPECT_LT(distance(upright[i].map_T_base, leaning[i].map_T_base), 1e-9);
    EXPECT_NEAR(upright[i].probability, leaning[i].probability, 1e-6);
  }
}

TEST(Initialise, ProbabilitiesAreSharesOfOneWhole) {
  const test::HandMadeWorld world;
  InitialiseOptions options;
  options.distinct.count = 400;
  const auto hypotheses = initialise(*world.maps->field, world.maps->building_axis_rad,
                                     reading_at(world, {5.2, 1.1, 0}, 0, Eigen::Isometry3d::Identity()),
                                     Eigen::Isometry3d::Identity(), options);
  const double sum = std::accumulate(hypotheses.begin(), hypotheses.end(), 0.0,
                                     [](double s, const InitialHypothesis& h) { return s + h.probability; });
  EXPECT_NEAR(sum, 1.0, 1e-3) << "all distinct places together hold the whole of Eq. 2";
  for (std::size_t i = 1; i < hypotheses.size(); ++i) EXPECT_GE(hypotheses[i].probability, 0.0);
}

TEST(HeadedObservations, AllowForAnErrorOfTheAlignmentAcrossTheHorizontalFieldOnly) {
  InitialiseOptions options;
  options.field_sigma_uT = 0.5;
  options.align_sigma_rad = 0.1;
  const auto observations = headed_observations({20, 0, -40}, 0.0, options);
  ASSERT_EQ(observations.size(), 4u);
  EXPECT_NEAR(observations[0].covariance_uT2(0, 0), 0.25, 1e-9);
  EXPECT_NEAR(observations[0].covariance_uT2(1, 1), 0.25 + 4.0, 1e-9);
  EXPECT_NEAR(observations[0].covariance_uT2(2, 2), 0.25, 1e-9);
  EXPECT_NEAR((observations[2].field_uT - Eigen::Vector3d(0, 20, -40)).norm(), 0.0, 1e-9) << "+90 deg";
}

}  // namespace
}  // namespace mstsl
