#include "mstsl/sim/steel.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"
#include "mstsl/sim/world.hpp"

#include "test_support.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d any_vector(Random& random, double size) {
  return size * Vector3d(random.normal(), random.normal(), random.normal());
}

/// dB_i / dx_j by central differences.
template <typename Field>
Matrix3d gradient(const Field& field, const Vector3d& at, double step_m = 1e-4) {
  Matrix3d result;
  for (int j = 0; j < 3; ++j) {
    const Vector3d step = step_m * Vector3d::Unit(j);
    result.col(j) = (field(at + step) - field(at - step)) / (2.0 * step_m);
  }
  return result;
}

TEST(EarthField, PointsNorthAndDownInEurope) {
  const EarthField earth{50.0, radians(60.0), radians(90.0)};
  const Vector3d field = earth.in_map_uT();
  EXPECT_NEAR(field.norm(), 50.0, 1e-12);
  EXPECT_NEAR(field.x(), 0.0, 1e-12);
  EXPECT_NEAR(field.y(), 25.0, 1e-12);
  EXPECT_LT(field.z(), 0.0);
}

TEST(EarthField, PointsUpSouthOfTheEquator) {
  EXPECT_GT((EarthField{50.0, radians(-60.0), 0.0}).in_map_uT().z(), 0.0);
}

TEST(PolePair, IsADipoleFarAway) {
  Random random(1);
  const PolePair pair{{0.1, 0.2, 0.3}, {-0.1, 0.1, 0.2}, 2.5};
  const Vector3d middle = 0.5 * (pair.positive_m + pair.negative_m);
  const Vector3d moment = pair.strength_uTm2 * (pair.positive_m - pair.negative_m);
  for (int i = 0; i < 50; ++i) {
    const Vector3d r = 30.0 * any_vector(random, 1.0).normalized();
    const Vector3d dipole = (3.0 * moment.dot(r) / r.squaredNorm() * r - moment) / std::pow(r.norm(), 3);
    EXPECT_NEAR((field_uT(pair, middle + r) - dipole).norm() / dipole.norm(), 0.0, 1e-3);
  }
}

TEST(PolePair, HasTheFieldOfTwoPointCharges) {
  const PolePair pair{{1, 0, 0}, {-1, 0, 0}, 3.0};
  EXPECT_NEAR((field_uT(pair, {3, 0, 0}) - Vector3d(3.0 / 4 - 3.0 / 16, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((field_uT(pair, {0, 0, 1}) - Vector3d(-2 * 3.0 / std::pow(2.0, 1.5), 0, 0)).norm(), 0.0, 1e-12);
}

TEST(PolePair, StaysFiniteAtItsCharges) {
  const PolePair pair{{1, 0, 0}, {-1, 0, 0}, 3.0};
  EXPECT_TRUE(field_uT(pair, pair.positive_m).allFinite());
  EXPECT_LE(field_uT(pair, {1.0, 0.0, 0.05}).norm(), 3.0 / (0.05 * 0.05) + 1.0);
}

/// Pair by pair, without the tree.
Vector3d plain_sum(const SteelField& field, const Vector3d& position) {
  Vector3d sum = field.earth().in_map_uT();
  for (const PolePair& pair : field.pairs()) sum += field_uT(pair, position);
  return sum;
}

TEST(SteelField, HasNeitherSourcesNorCurlsAwayFromThePoles) {
  const World world = test::must(make_world("corridor", {}, Random(1)));
  Random random(2);
  double steepest = 0.0;
  for (int i = 0; i < 30; ++i) {
    const Lane& lane = world.lanes()[random.index(world.lanes().size())];
    const Eigen::Vector2d at = point_along(lane.center, random.uniform());
    const Matrix3d g =
        gradient([&](const Vector3d& p) { return plain_sum(world.field(), p); }, {at.x(), at.y(), 0.7});
    const double scale = g.cwiseAbs().maxCoeff();
    steepest = std::max(steepest, scale);
    EXPECT_NEAR(g.trace(), 0.0, 1e-5 * std::max(1.0, scale));
    EXPECT_NEAR((g - g.transpose()).cwiseAbs().maxCoeff(), 0.0, 1e-5 * std::max(1.0, scale));
  }
  EXPECT_GT(steepest, 1.0) << "a field without structure would pass any law";
}

TEST(SteelField, AgreesWithThePlainSumOverAllPairs) {
  constexpr double kNegligible_uT = 0.2;  // of spreads of 5 uT and more; the same at every visit, so no noise
  for (const std::string& name : world_names()) {
    const World world = test::must(make_world(name, {}, Random(3)));
    Random random(4);
    double square_sum = 0.0;
    constexpr int kPoints = 60;
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector2d at =
          point_along(world.lanes()[random.index(world.lanes().size())].center, random.uniform());
      const Vector3d position(at.x(), at.y(), random.uniform(0.3, 1.5));
      const double error = (world.field_uT(position) - plain_sum(world.field(), position)).norm();
      EXPECT_LT(error, kNegligible_uT) << name;
      square_sum += error * error;
    }
    EXPECT_LT(std::sqrt(square_sum / kPoints), 0.08) << name;
  }
}

TEST(SteelField, IsTheEarthsWithoutSteel) {
  const EarthField earth{40.0, radians(10.0), radians(30.0)};
  const SteelField field(earth, {});
  EXPECT_EQ(field.field_uT({1, 2, 3}), earth.in_map_uT());
  EXPECT_EQ(SteelField().field_uT({1, 2, 3}), EarthField{}.in_map_uT());
}

TEST(Rod, IsMagnetisedAlongTheEarthsField) {
  const EarthField earth{50.0, radians(90.0), 0.0};  // straight down
  const Rod upright{{0, 0, 0}, {0, 0, 2}, 5e-3, 0.0};
  const PolePair pair = magnetised(upright, earth);
  EXPECT_LT(pair.strength_uTm2, 0.0) << "the north pole, where field comes out, is the lower end";
  const Rod lying{{0, 0, 0}, {2, 0, 0}, 5e-3, 0.0};
  EXPECT_NEAR(magnetised(lying, earth).strength_uTm2, 0.0, 1e-9);
}

TEST(Rod, KeepsItsRemanenceInAnyField) {
  const EarthField none{0.0, 0.0, 0.0};
  const Rod rod{{0, 0, 0}, {0, 1, 0}, 2e-3, 1e4};
  EXPECT_NEAR(magnetised(rod, none).strength_uTm2, 0.1 * 1e4 * 2e-3, 1e-12);  // mu0 M A / 4 pi
}

TEST(Rod, IsHarderToMagnetiseWhenStout) {
  const EarthField earth{50.0, radians(90.0), 0.0};
  const auto magnetisation = [&](double length_m) {
    const double section_m2 = 1e-2;
    return std::abs(magnetised({{0, 0, 0}, {0, 0, length_m}, section_m2, 0.0}, earth).strength_uTm2) /
           section_m2;
  };
  EXPECT_GT(magnetisation(10.0), 3.0 * magnetisation(1.0));
  // A ball's demagnetising factor is 1/3: M = 3 H for soft iron, H = B / mu0.
  const double h_A_per_m = 50.0 / (0.4 * kPi);
  EXPECT_NEAR(magnetisation(2.0 * std::sqrt(1e-2 / kPi)), 0.1 * 3.0 * h_A_per_m, 0.1 * 0.1 * 3.0 * h_A_per_m);
}

}  // namespace
}  // namespace mstsl::sim
