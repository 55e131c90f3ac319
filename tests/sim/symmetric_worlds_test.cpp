#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "mstsl/sim/world.hpp"

#include "test_support.hpp"

namespace mstsl::sim {
namespace {

using test::must;

bool has_image(const SegmentIndex& surfaces, const Segment& segment) {
  const auto near = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) { return (p - q).norm() < 1e-9; };
  return std::any_of(surfaces.segments().begin(), surfaces.segments().end(), [&](const Segment& other) {
    return (near(other.a, -segment.a) && near(other.b, -segment.b)) ||
           (near(other.a, -segment.b) && near(other.b, -segment.a));
  });
}

class SymmetricWorld : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Hard, SymmetricWorld,
                         ::testing::Values("symmetric-loop", "aisles", "pillar-hall", "h-wing"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(SymmetricWorld, LooksTheSameTurnedBy180Degrees) {
  const World world = must(make_world(GetParam(), {}, Random(7)));
  for (const Segment& segment : world.surfaces().segments())
    EXPECT_TRUE(has_image(world.surfaces(), segment)) << segment.a.transpose();
}

TEST_P(SymmetricWorld, StaysSymmetricWhenThingsMove) {
  const World world = on_another_day(must(make_world(GetParam(), {}, Random(7))), 1.0, Random(8));
  for (const Segment& segment : world.surfaces().segments())
    EXPECT_TRUE(has_image(world.surfaces(), segment)) << segment.a.transpose();
}

TEST_P(SymmetricWorld, HasAFieldThatIsNot) {
  const World world = must(make_world(GetParam(), {}, Random(7)));
  double squares = 0.0;
  int count = 0;
  for (const Lane& lane : world.lanes())
    for (double t = 0.0; t <= 1.0; t += 0.02, ++count) {
      const Eigen::Vector2d p = point_along(lane.center, t);
      const Eigen::Vector3d here = world.field_uT({p.x(), p.y(), 0.7}),
                            there = world.field_uT({-p.x(), -p.y(), 0.7});
      squares += (here - there).squaredNorm() / 3.0;
    }
  EXPECT_GT(std::sqrt(squares / count), 2.0);
}

TEST(Aisles, AreEight) {
  const World world = must(make_world("aisles", {}, Random(1)));
  EXPECT_EQ(world.lanes().size(), 2u + 8u);
}

TEST(Office, IsNotSymmetric) {
  const World world = must(make_world("office", {}, Random(1)));
  std::size_t images = 0;
  for (const Segment& segment : world.surfaces().segments()) images += has_image(world.surfaces(), segment);
  EXPECT_LT(images, world.surfaces().segments().size() / 10);
}

TEST(AnotherDay, ChangesSteelAloneWhereAsked) {
  const World before = must(make_world("carpark", {}, Random(1)));
  const World after = on_another_day(before, 1.0, Random(2), Change::kSteelOnly);
  ASSERT_EQ(before.surfaces().segments().size(), after.surfaces().segments().size());
  for (std::size_t i = 0; i < before.surfaces().segments().size(); ++i)
    EXPECT_EQ(before.surfaces().segments()[i].a, after.surfaces().segments()[i].a);
  EXPECT_GT((before.field_uT({0, 0, 0.7}) - after.field_uT({0, 0, 0.7})).norm(), 0.01);
}

}  // namespace
}  // namespace mstsl::sim
