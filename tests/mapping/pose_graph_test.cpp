#include "mstsl/mapping/pose_graph.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

const Eigen::Matrix3d kSure = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
const Eigen::Matrix3d kUnsure = Eigen::Vector3d(400, 400, 2000).asDiagonal();

/// Steps of half a metre round a square of 10 m, once and a bit.
std::vector<Pose2> square_steps() {
  std::vector<Pose2> steps;
  for (int side = 0; side < 5; ++side) {
    for (int i = 0; i < 20; ++i) steps.push_back({0.5, 0, 0});
    steps.back().yaw = kPi / 2;
  }
  return steps;
}

/// What wheels with a fault say of a true step.
Pose2 said(const Pose2& step, const WheelCalibration& fault) {
  const double yaw = (step.yaw - fault.drift_rad_per_m * step.x / (1 + fault.scale)) / (1 + fault.turn_scale);
  return {step.x / (1 + fault.scale), step.y / (1 + fault.scale), yaw};
}

TEST(PoseGraph, AClosureTakesTheDriftOut) {
  PoseGraph graph;
  std::vector<Pose2> truth{{}};
  graph.add(ChainLink{});
  Random random(1);
  for (const Pose2& step : square_steps()) {
    truth.push_back(truth.back() * step);
    const Pose2 measured =
        step * Pose2{random.normal(0, 0.01), random.normal(0, 0.01), random.normal(0.004, 0.004)};
    graph.add({measured, kUnsure, measured, kUnsure});
  }
  const double drifted_m = distance(graph.pose(95), truth[95]);
  graph.add(Closure{.from = 0, .to = 80, .from_T_to = between(truth[0], truth[80]), .information = kSure});
  graph.add(Closure{.from = 15, .to = 95, .from_T_to = between(truth[15], truth[95]), .information = kSure});
  graph.optimise();
  EXPECT_LT(distance(graph.pose(95), truth[95]), 0.3 * drifted_m);
  EXPECT_LT(distance(graph.pose(80), truth[80]), 0.05);
  for (const Closure& c : graph.closures()) EXPECT_FALSE(c.refuted);
}

TEST(PoseGraph, AWrongClosureIsRefutedByTheOthers) {
  PoseGraph graph;
  std::vector<Pose2> truth{{}};
  graph.add(ChainLink{});
  for (const Pose2& step : square_steps()) {
    truth.push_back(truth.back() * step);
    graph.add({step, kUnsure, step, kSure});
  }
  for (std::size_t i = 0; i < 15; ++i)
    graph.add(Closure{
        .from = i, .to = i + 80, .from_T_to = between(truth[i], truth[i + 80]), .information = kSure});
  graph.add(Closure{.from = 10, .to = 70, .from_T_to = {0.2, 0.1, 0.0}, .information = kSure});
  graph.optimise();
  EXPECT_TRUE(graph.closures().back().refuted);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_FALSE(graph.closures()[i].refuted) << i;
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_LT(distance(graph.pose(i), truth[i]), 0.02) << i;
}

TEST(PoseGraph, LearnsWhatIsWrongWithTheWheels) {
  const WheelCalibration fault{.scale = 0.03, .drift_rad_per_m = radians(1.0), .turn_scale = -0.02};
  PoseGraph graph;
  graph.add(ChainLink{});
  for (const Pose2& step : square_steps()) graph.add({said(step, fault), kUnsure, step, kSure});
  graph.optimise();
  EXPECT_NEAR(graph.wheels().scale, fault.scale, 0.005);
  EXPECT_NEAR(graph.wheels().drift_rad_per_m, fault.drift_rad_per_m, 0.002);
  EXPECT_NEAR(graph.wheels().turn_scale, fault.turn_scale, 0.01);
  const Pose2 step{0.5, 0.1, 0.3}, corrected = graph.wheels().corrected(said(step, fault));
  EXPECT_NEAR(corrected.x, step.x, 0.01);
  EXPECT_NEAR(corrected.yaw, step.yaw, 0.02);
}

std::vector<Eigen::Matrix3d> all_covariances(const PoseGraph& graph) {
  std::vector<std::size_t> nodes(graph.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return graph.covariances_from_last(nodes);
}

TEST(PoseGraph, UncertaintyGrowsWithTheWayAndShrinksOverClosures) {
  PoseGraph graph;
  graph.add(ChainLink{});
  for (const Pose2& step : square_steps()) graph.add({step, kUnsure, step, kUnsure});
  const auto open = all_covariances(graph);
  EXPECT_EQ(open.back(), Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  const auto size = [](const Eigen::Matrix3d& covariance) { return covariance(0, 0) + covariance(1, 1); };
  EXPECT_GT(size(open[50]), size(open[90]));
  const Pose2 last_T_20 = between(graph.pose(100), graph.pose(20));
  graph.add(Closure{.from = 20, .to = 100, .from_T_to = inverse(last_T_20), .information = kSure});
  const auto closed = all_covariances(graph);
  EXPECT_LT(size(closed[20]), 0.1 * size(open[20]));
  EXPECT_NEAR(closed[99](0, 0), open[99](0, 0), 1e-12);
}

TEST(PoseGraph, UncertaintyOfSomeIsThatOfAll) {
  PoseGraph graph;
  graph.add(ChainLink{});
  for (const Pose2& step : square_steps()) graph.add({step, kUnsure, step, kUnsure});
  graph.add(Closure{.from = 20, .to = 95, .from_T_to = {1, 2, 0.3}, .information = kSure});
  graph.add(Closure{.from = 90, .to = 15, .from_T_to = {0, 1, 0}, .information = kUnsure});
  const auto all = all_covariances(graph);
  const std::vector<std::size_t> some{15, 99, 15, 60, 20};
  const auto found = graph.covariances_from_last(some);
  ASSERT_EQ(found.size(), some.size());
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(found[i], all[some[i]]) << some[i];
  EXPECT_TRUE(graph.covariances_from_last({}).empty());
}

/// The covariance along one chain against many chains drawn with its errors.
TEST(PoseGraph, UncertaintyIsWhatManyDrivesShow) {
  PoseGraph graph;
  graph.add(ChainLink{});
  std::vector<Pose2> steps = square_steps();
  steps.resize(30);
  for (const Pose2& step : steps) graph.add({step, kUnsure, step, kUnsure});
  const Eigen::Matrix3d claimed = all_covariances(graph).front();
  const Pose2 last_T_first = between(graph.pose(30), graph.pose(0));
  Random random(5);
  Eigen::Matrix3d seen = Eigen::Matrix3d::Zero();
  constexpr int kDrives = 4000;
  for (int i = 0; i < kDrives; ++i) {
    Pose2 end;
    for (const Pose2& step : steps)  // errors in the axes of the step's start
      end = end * Pose2::from({step.x + random.normal(0, std::sqrt(1 / 800.0)),
                               step.y + random.normal(0, std::sqrt(1 / 800.0))},
                              step.yaw + random.normal(0, std::sqrt(1 / 4000.0)));
    const Pose2 back = inverse(end);
    const Eigen::Vector3d e(back.x - last_T_first.x, back.y - last_T_first.y,
                            angle_between(last_T_first.yaw, back.yaw));
    seen += e * e.transpose() / kDrives;
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::sqrt(claimed(k, k) / seen(k, k)), 1.0, 0.1) << k;
}

TEST(PoseGraph, ADriveThatHangsOnNothingCanBeMoved) {
  PoseGraph graph;
  graph.add(ChainLink{});
  graph.add({{1, 0, 0}, kUnsure, {1, 0, 0}, kSure});
  graph.add(ChainLink{});  // another drive
  graph.add({{1, 0, 0}, kUnsure, {1, 0, 0}, kSure});
  EXPECT_GT(all_covariances(graph).front()(0, 0), 1000.0);
  graph.move_tail(2, 3, {5, 5, kPi / 2});
  EXPECT_LT(distance(graph.pose(2), {5, 4, kPi / 2}), 1e-9);
  EXPECT_LT(distance(graph.pose(1), {1, 0, 0}), 1e-9);
  graph.add(Closure{.from = 1, .to = 3, .from_T_to = {4, 5, kPi / 2}, .information = kSure});
  graph.optimise();
  EXPECT_LT(distance(graph.pose(3), {5, 5, kPi / 2}), 1e-6);
}

}  // namespace
}  // namespace mstsl
