#include "io/log/frame_tree.hpp"

#include <gtest/gtest.h>

namespace mstsl::io {
namespace {

Eigen::Isometry3d motion(double x, double angle_rad) {
  return Eigen::Translation3d(x, 0.5, -1.0) *
         Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 3).normalized());
}

TEST(FrameTree, ComposesAlongTheChain) {
  FrameTree tree;
  tree.add("base_link", "mast", motion(1.0, 0.3));
  tree.add("mast", "imu_link", motion(2.0, -0.7));
  ASSERT_TRUE(tree.find("base_link", "imu_link").has_value());
  EXPECT_TRUE(tree.find("base_link", "imu_link")->isApprox(motion(1.0, 0.3) * motion(2.0, -0.7), 1e-12));
}

TEST(FrameTree, FollowsTransformsInEitherDirection) {
  FrameTree tree;
  tree.add("laser", "base_link", motion(1.0, 0.3));
  tree.add("laser", "imu_link", motion(2.0, 0.1));
  EXPECT_TRUE(tree.find("base_link", "laser")->isApprox(motion(1.0, 0.3).inverse(), 1e-12));
  EXPECT_TRUE(
      tree.find("base_link", "imu_link")->isApprox(motion(1.0, 0.3).inverse() * motion(2.0, 0.1), 1e-12));
}

TEST(FrameTree, IgnoresLeadingSlashes) {
  FrameTree tree;
  tree.add("/base_link", "laser", motion(1.0, 0.3));
  EXPECT_TRUE(tree.find("base_link", "/laser").has_value());
  EXPECT_EQ(tree.frames(), (std::vector<std::string>{"base_link", "laser"}));
}

TEST(FrameTree, FindsNoWayBetweenSeparateTrees) {
  FrameTree tree;
  tree.add("base_link", "laser", motion(1.0, 0.3));
  tree.add("map", "odom", motion(1.0, 0.3));
  EXPECT_FALSE(tree.find("base_link", "odom").has_value());
  EXPECT_FALSE(tree.find("base_link", "nowhere").has_value());
}

TEST(FrameTree, AFrameLiesAtItself) {
  EXPECT_TRUE(FrameTree().find("imu_link", "/imu_link")->isApprox(Eigen::Isometry3d::Identity()));
}

TEST(FrameTree, EndsOnCycles) {
  FrameTree tree;
  tree.add("a", "b", motion(1.0, 0.1));
  tree.add("b", "c", motion(1.0, 0.1));
  tree.add("c", "a", motion(1.0, 0.1));
  EXPECT_TRUE(tree.find("a", "c").has_value());
  EXPECT_FALSE(tree.find("a", "d").has_value());
}

}  // namespace
}  // namespace mstsl::io
