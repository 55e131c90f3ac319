#include "mstsl/localize/field_witness.hpp"

#include <gtest/gtest.h>

#include "hand_made_world.hpp"

namespace mstsl {
namespace {

class FieldWitnessTest : public testing::Test {
 protected:
  test::HandMadeWorld world;
  Eigen::Isometry3d base_T_sensor = [] {
    Eigen::Isometry3d mounting = Eigen::Isometry3d::Identity();
    mounting.translation() << -0.1, 0.15, 0.7;
    return mounting;
  }();

  /// Drives along the southern corridor while it is believed that it drives elsewhere.
  FieldWitness after_drive(const Pose2& true_T_believed, const Eigen::Vector3d& bias_uT, int scans) const {
    FieldWitness witness;
    for (int i = 0; i < scans; ++i) {
      const Pose2 pose{4.0 + 0.1 * i, 1.0, radians(20)};
      witness.observe(
          world.maps->field_cells, world.field_at(Stamp{}, pose, base_T_sensor).sensor_field_uT + bias_uT,
          Pose2{true_T_believed.x + pose.x, true_T_believed.y + pose.y, true_T_believed.yaw + pose.yaw},
          base_T_sensor.translation().head<2>());
    }
    return witness;
  }
};

TEST_F(FieldWitnessTest, SpeaksForTheRightPoseInSpiteOfBias) {
  EXPECT_TRUE(after_drive({}, Eigen::Vector3d::Zero(), 15).agrees());
  EXPECT_TRUE(after_drive({}, {3.0, -3.0, 2.0}, 15).agrees());
}

TEST_F(FieldWitnessTest, SpeaksAgainstAnotherPlaceAndAnotherHeading) {
  EXPECT_FALSE(after_drive({10.0, 0.0, 0.0}, Eigen::Vector3d::Zero(), 15).agrees());
  EXPECT_FALSE(after_drive({0.0, 8.0, 0.0}, Eigen::Vector3d::Zero(), 15).agrees());
  EXPECT_FALSE(after_drive({0.0, 0.0, radians(180)}, Eigen::Vector3d::Zero(), 15).agrees());
}

TEST_F(FieldWitnessTest, IsSilentWithFewReadingsAndWhereThereIsNoMap) {
  EXPECT_FALSE(after_drive({}, Eigen::Vector3d::Zero(), 7).agrees());
  EXPECT_FALSE(after_drive({0.0, 500.0, 0.0}, Eigen::Vector3d::Zero(), 15).agrees());
}

}  // namespace
}  // namespace mstsl
