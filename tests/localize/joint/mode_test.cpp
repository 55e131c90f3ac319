#include "mstsl/localize/joint/mode.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

#include "../../../src/localize/joint/kalman.hpp"
#include "../hand_made_world.hpp"

namespace mstsl::joint {
namespace {

Eigen::Matrix3d diagonal(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

/// A station measured without error at a pose.
Station station_at(const test::HandMadeWorld& world, const Pose2& map_T_base,
                   const Eigen::Vector3d& bias_uT) {
  Station station;
  station.base_field_uT =
      world.field_at({}, map_T_base, Eigen::Isometry3d::Identity()).sensor_field_uT + bias_uT;
  return station;
}

double least_eigenvalue(const Covariance& covariance) {
  return Eigen::SelfAdjointEigenSolver<Covariance>(covariance, Eigen::EigenvaluesOnly).eigenvalues()(0);
}

TEST(MapError, IsStationaryAndCorrelatedAsMatern) {
  const Eigen::Vector3d variance(4, 9, 1);
  Vector state = Vector::Zero();
  Covariance covariance = Covariance::Zero();
  forget_map_error(state, covariance, variance);
  // The covariance of the error now with that after a way, by carrying a unit of it along.
  for (const double way_m : {0.05, 0.25, 1.0, 3.0}) {
    Covariance after = covariance;
    Vector moved = state;
    moved(kMapError) = 1.0;
    let_wander(moved, after, way_m, 0.58, variance);
    EXPECT_LT((after - covariance).norm(), 1e-9);
    const double a = std::sqrt(3.0) * way_m / 0.58;
    EXPECT_NEAR(moved(kMapError), (1 + a) * std::exp(-a), 1e-12);
  }
  const double quarter = std::sqrt(3.0) * 0.25 / FieldModel{}.error_length_m, one = 4 * quarter;
  EXPECT_NEAR((1 + quarter) * std::exp(-quarter), 0.85, 0.05);  // as was measured
  EXPECT_NEAR((1 + one) * std::exp(-one), 0.2, 0.02);
}

TEST(MapError, DoesNotCareInHowManyStepsAWayIsDriven) {
  Vector once = Vector::Random(), often = once;
  Covariance p = Covariance::Random();
  p = p * p.transpose();
  Covariance q = p;
  let_wander(once, p, 0.6, 0.5, {1, 2, 3});
  for (int i = 0; i < 6; ++i) let_wander(often, q, 0.1, 0.5, {1, 2, 3});
  EXPECT_LT((once - often).norm(), 1e-12);
  EXPECT_LT((p - q).norm(), 1e-9);
}

TEST(Mode, LearnsTheBiasOfTheMagnetometerFromATurn) {
  const test::HandMadeWorld world;
  const Eigen::Vector3d bias_uT(4, -6, 3);
  const Pose2 start{5, 1, 0};
  Mode mode = make_mode(start, diagonal(0.02, 0.01), {});
  for (int i = 0; i <= 60; ++i) {
    const Pose2 now = start * Pose2{0.05 * i, 0, radians(6) * i};
    if (i > 0)
      predict(mode, between(start * Pose2{0.05 * (i - 1), 0, radians(6) * (i - 1)}, now),
              diagonal(1e-3, 1e-3), 0);
    Station station = station_at(world, now, bias_uT);
    if (i > 0) station.since_last_m = 0.05;
    update_by_field(mode, station, world.maps->field_cells, {0, 0}, {});
    update_by_scan(mode, {now, diagonal(0.02, 0.005).inverse(), 1.0});
  }
  EXPECT_LT((mode.state.segment<3>(kBias) - bias_uT).norm(), 1.0);
  EXPECT_GT(least_eigenvalue(mode.covariance), 0.0);
}

TEST(Mode, StaysANumberInAFieldThatIsTheSameEverywhere) {
  const test::HandMadeWorld world;
  FieldMap field = world.field_map();
  for (std::size_t i = 0; i < field.mean_uT.size(); ++i) {
    field.mean_uT[i] = {20, 0, -40};
    field.variance_uT2[i].setZero();
    field.supported[i] = 1;
  }
  const FieldSampler same(field);
  Mode mode = make_mode({6, 1, 0.3}, diagonal(0.1, 0.02), {});
  for (int i = 0; i < 10; ++i) {
    Station station = station_at(world, {6, 1, 0.3}, {0, 0, 0});
    station.since_last_m = 0.12;
    EXPECT_TRUE(std::isfinite(update_by_field(mode, station, same, {0, 0}, {})));
  }
  EXPECT_TRUE(mode.state.allFinite() && mode.covariance.allFinite());
}

TEST(Mode, IsDrawnToWhereTheFieldWasRead) {
  const test::HandMadeWorld world;
  const Pose2 truth{6, 1, 0.3};
  Mode mode = make_mode(truth * Pose2{0.12, -0.08, 0.0}, diagonal(0.12, 0.01),
                        {.bias_sigma_uT = 0.1, .motor_sigma_uT = 0.1});
  const double before_m = distance(mode.map_T_base, truth);
  update_by_field(mode, station_at(world, truth, {0, 0, 0}), world.maps->field_cells, {0, 0}, {});
  EXPECT_LT(distance(mode.map_T_base, truth), 0.6 * before_m);
}

TEST(Mode, AtTheRightPlaceExplainsAWayBetterThanAtWrongOnes) {
  const test::HandMadeWorld world;
  const auto log_density = [&](const Pose2& from, const Pose2& truth) {
    Mode mode = make_mode(from, diagonal(0.05, 0.02), {});
    double sum = 0;
    for (int i = 0; i < 15; ++i) {
      Station station = station_at(world, truth * Pose2{0.1 * i, 0, 0}, {5, 5, -5});
      if (i > 0) station.since_last_m = 0.1, predict(mode, {0.1, 0, 0}, diagonal(0.01, 0.005), 0);
      sum += update_by_field(mode, station, world.maps->field_cells, {0, 0}, {});
    }
    return sum;
  };
  const Pose2 truth{4, 1, 0};
  const double right = log_density(truth, truth);
  for (const Pose2& wrong : {Pose2{12, 1, 0}, Pose2{18, 9, kPi}, Pose2{1, 5, kPi / 2}, Pose2{8, 1, kPi}})
    EXPECT_GT(right, log_density(wrong, truth) + 5) << wrong.x;
}

/// Log density of so many stations taken while the robot turns on the spot, the true field being off the map
/// by a constant.
double of_a_turn(const test::HandMadeWorld& world, float variance_uT2, const Eigen::Vector3d& off_uT,
                 int stations) {
  FieldMap field = world.field_map();
  for (Eigen::Vector3f& cell : field.variance_uT2) cell.setConstant(variance_uT2);
  const FieldSampler sampler(field);
  const Pose2 start{6, 1, 0.3};
  Mode mode = make_mode(start, diagonal(0.02, 0.01), {});
  double sum = 0;
  for (int i = 0; i < stations; ++i) {
    const Pose2 turn{0, 0, radians(15.0)};
    if (i > 0) predict(mode, turn, diagonal(0.001, 0.005), 0);
    const Pose2 now = start * Pose2{0, 0, i * turn.yaw};
    Station station =
        station_at(world, now, about_z(now.yaw).transpose() * off_uT + Eigen::Vector3d(4, -3, 2));
    if (i > 0) station.since_last_m = 0.0;
    sum += update_by_field(mode, station, sampler, {0, 0}, {});
    update_by_scan(mode, {now, Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal().toDenseMatrix(), 1.0});
  }
  return sum;
}

TEST(Mode, ATurnOnTheSpotIsOneWitness) {
  const test::HandMadeWorld world;
  // The right place, whose map is unsure and off by as much as it says, against one that is sure and right by
  // luck: after a quarter turn bias and map error are told apart, and going round and round must tell no
  // more.
  const auto against_truth = [&](int stations) {
    return of_a_turn(world, 0.2F, {0, 0, 0}, stations) - of_a_turn(world, 25.0F, {5, -4, 3}, stations);
  };
  EXPECT_LT(against_truth(6), 12.0);
  EXPECT_NEAR(against_truth(48), against_truth(6), 3.0);
}

TEST(Mode, SurvivesChangedSteelByAJump) {
  const test::HandMadeWorld world;
  const Pose2 start{4, 1, 0};
  Mode mode = make_mode(start, diagonal(0.05, 0.02), {});
  for (int i = 0; i < 40; ++i) {
    // Between 1 and 2 m the field is off by 15 uT all of a sudden.
    const Eigen::Vector3d changed = i >= 10 && i < 20 ? Eigen::Vector3d(15, -9, 12) : Eigen::Vector3d::Zero();
    Station station = station_at(world, start * Pose2{0.1 * i, 0, 0}, changed);
    if (i > 0) station.since_last_m = 0.1, predict(mode, {0.1, 0, 0}, diagonal(0.01, 0.005), 0);
    update_by_field(mode, station, world.maps->field_cells, {0, 0}, {});
    update_by_scan(
        mode, {start * Pose2{0.1 * i, 0, 0}, Eigen::Vector3d(0, 1e4, 1e4).asDiagonal().toDenseMatrix(), 1.0});
  }
  EXPECT_LT(distance(mode.map_T_base, start * Pose2{3.9, 0, 0}), 0.15);
}

TEST(ErrorScale, FollowsWhatStationsShowAndForgetsIt) {
  ErrorScale scale;
  EXPECT_EQ(scale.factor(), 1.0);
  for (int i = 0; i < 20; ++i) scale.learn(0.15, 0.12, 1.0, 1.0);  // a fifth of the deviation expected
  EXPECT_LT(scale.factor(), 0.25);
  ErrorScale later = scale;
  later.learn(3.0, 10.0, 1.0, 1.0);  // ten metres on, as expected
  EXPECT_NEAR(later.factor(), 1.0, 0.01);
  scale.learn(1e9, 0.12, 1.0, 1.0);  // one wild station is not a rule
  EXPECT_LT(scale.factor(), 3.0);
}

TEST(Surprise, OfVariancesThatAreAllWrongByAFactor) {
  Eigen::Matrix3d covariance;
  covariance << 4, 1, 0.5, 1, 3, -0.2, 0.5, -0.2, 2;
  const Eigen::Vector3d off(1.5, -2, 0.7);
  for (const double factor : {0.1, 1.0, 7.0})
    EXPECT_NEAR(Surprise(covariance, off).log_density(factor),
                Surprise(factor * covariance, off).log_density(), 1e-12);
}

/// Twenty stations that are off a map by a hundredth of a microtesla, at a place whose map claims `sd_uT`.
double log_density_on_a_map_of(double sd_uT, double scale_length_m) {
  const test::HandMadeWorld world;
  const Pose2 start{4, 1, 0};
  FieldModel model;
  model.map_error_floor_uT = sd_uT;
  model.scale_length_m = scale_length_m;
  Mode mode = make_mode(start, diagonal(0.02, 0.01), model);
  double sum = 0;
  for (int i = 0; i < 40; ++i) {
    Station station = station_at(world, start * Pose2{0.12 * i, 0, 0}, {0.01, -0.01, 0.01});
    if (i > 0) station.since_last_m = 0.12, predict(mode, {0.12, 0, 0}, diagonal(0.003, 0.002), 0);
    const double log_density = update_by_field(mode, station, world.maps->field_cells, {0, 0}, model);
    if (i >= 20) sum += log_density;
  }
  return sum;
}

TEST(Mode, IsNotRuledOutForAModestMapThatFits) {
  const double kForgetsAtOnce_m = 1e-3;
  EXPECT_GT(log_density_on_a_map_of(3.0, 1.0), log_density_on_a_map_of(3.0, kForgetsAtOnce_m) + 20 * 1.0);
}

TEST(Mode, FollowsAMapThatIsWorseThanItClaims) {
  // 3 uT off all of a sudden, on a map that claims 1 uT: after half a metre that is no news any more.
  const test::HandMadeWorld world;
  const Pose2 start{4, 1, 0};
  Mode mode = make_mode(start, diagonal(0.02, 0.01), {.bias_sigma_uT = 0.5, .motor_sigma_uT = 0.5});
  double first = 0, later = 0;
  for (int i = 0; i < 24; ++i) {
    const Eigen::Vector3d off = i < 12 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(3, -3, 3);
    Station station = station_at(world, start * Pose2{0.12 * i, 0, 0}, off);
    if (i > 0) station.since_last_m = 0.12, predict(mode, {0.12, 0, 0}, diagonal(0.003, 0.002), 0);
    const double log_density = update_by_field(mode, station, world.maps->field_cells, {0, 0}, {});
    (i == 12 ? first : later) = log_density;
  }
  EXPECT_GT(later, first + 3.0);
}

TEST(Mode, TakesFromAScanOnlyWhatItFixes) {
  Mode mode = make_mode({1, 2, 0}, diagonal(0.3, 0.1), {});
  // Along a corridor in x nothing is known.
  update_by_scan(mode, {{1.2, 2.1, 0.05}, Eigen::Vector3d(0, 1e6, 1e6).asDiagonal().toDenseMatrix(), 1.0});
  EXPECT_NEAR(mode.covariance(0, 0), 0.09, 1e-6);
  EXPECT_LT(mode.covariance(1, 1), 1e-5);
  EXPECT_NEAR(mode.map_T_base.y, 2.1, 1e-12);
  EXPECT_GE(least_eigenvalue(mode.covariance), -1e-9);
}

}  // namespace
}  // namespace mstsl::joint
