#include "mstsl/localize/orientation.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

const Eigen::Vector3d kUp(0, 0, 1);

/// The x axis of a frame D at a heading in G, in G's coordinates.
Eigen::Vector3d axis_at(double heading_rad) { return {std::cos(heading_rad), std::sin(heading_rad), 0.0}; }

TEST(Orientation, HasThePapersFourCases) {
  EXPECT_EQ(orientation({0.0, Eigen::Vector3d::Zero()}), 0.0);
  EXPECT_EQ(orientation({kPi, Eigen::Vector3d::Zero()}), -kPi);
  EXPECT_EQ(orientation({kPi / 2, kUp}), -kPi / 2);
  EXPECT_EQ(orientation({kPi / 2, -kUp}), kPi / 2);
}

TEST(Orientation, RecoversTheHeadingOfAFrameFromItsAxis) {
  for (const double heading_deg : kBuildingHeadings_deg) {
    const AxisAngle turn = turn_between(axis_at(radians(heading_deg)), Eigen::Vector3d::UnitX());
    EXPECT_NEAR(angle_between(orientation(turn), radians(heading_deg)), 0.0, 1e-12) << heading_deg << " deg";
  }
}

TEST(Orientation, TakesTheNearestCaseForAMeasuredAngle) {
  for (const double heading_deg : kBuildingHeadings_deg)
    for (const double error_deg : {-40.0, -5.0, 5.0, 40.0}) {
      const Eigen::Vector3d axis = axis_at(radians(heading_deg + error_deg));
      const double theta = orientation(turn_between(axis, Eigen::Vector3d::UnitX()));
      EXPECT_NEAR(angle_between(theta, radians(heading_deg)), 0.0, 1e-12)
          << heading_deg << " + " << error_deg;
    }
}

TEST(TurnBetween, GivesTheAngleAndTheAxisWhateverTheLengths) {
  const AxisAngle turn = turn_between({2, 0, 0}, {0, 0.1, 0});
  EXPECT_NEAR(turn.phi_rad, kPi / 2, 1e-12);
  EXPECT_NEAR((turn.axis - kUp).norm(), 0.0, 1e-12);
  EXPECT_EQ(turn_between({1, 0, 0}, {-3, 0, 0}).phi_rad, kPi);
  EXPECT_EQ(turn_between({1, 0, 0}, {-3, 0, 0}).axis, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace mstsl
