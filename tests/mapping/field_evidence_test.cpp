#include "mstsl/mapping/field_evidence.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

/// A field of waves, 0.5 to 3 m long, along any direction; `strength_uT` per axis.
class WavyField {
 public:
  WavyField(std::uint64_t seed, double strength_uT) : strength_uT_(strength_uT) {
    Random random(seed);
    for (int i = 0; i < 40; ++i) {
      const double direction = random.uniform(-kPi, kPi), per_m = 2 * kPi / random.uniform(1.5, 8.0);
      waves_.push_back({per_m * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                        random.uniform(0, 2 * kPi),
                        Eigen::Vector3d(random.normal(), random.normal(), random.normal())});
    }
  }
  Eigen::Vector3d at(const Eigen::Vector2d& p) const {
    Eigen::Vector3d sum(20, 5, -40);
    for (const Wave& w : waves_)
      sum += strength_uT_ * std::sqrt(2.0 / 40.0) * w.amplitude * std::sin(w.per_m.dot(p) + w.phase);
    return sum;
  }

 private:
  struct Wave {
    Eigen::Vector2d per_m;
    double phase;
    Eigen::Vector3d amplitude;
  };
  double strength_uT_;
  std::vector<Wave> waves_;
};

/// Readings along a straight way in the building, seen from a frame of which `building_T_frame` is known, by
/// a sensor with a bias, its robot facing along the way or against it.
std::vector<FieldAt> driven(const WavyField& field, const Eigen::Vector2d& from, double direction,
                            double length_m, const Pose2& building_T_frame, const Eigen::Vector3d& bias_uT,
                            Random random) {
  std::vector<FieldAt> readings;
  const Eigen::Vector2d along(std::cos(direction), std::sin(direction));
  const Eigen::Matrix2d frame_R_building = building_T_frame.rotation().transpose();
  for (double s = 0; s < length_m; s += 0.12) {
    const Eigen::Vector2d p = from + s * along;
    Eigen::Vector3d measured = field.at(p);
    measured.head<2>() += Eigen::Rotation2Dd(direction) * Eigen::Vector2d(bias_uT.x(), bias_uT.y());
    measured.z() += bias_uT.z();
    for (int k = 0; k < 3; ++k) measured[k] += random.normal(0, 0.2);
    const Eigen::Vector2d level = frame_R_building * measured.head<2>();
    readings.push_back({inverse(building_T_frame) * p,
                        {level.x(), level.y(), measured.z()},
                        angle_between(building_T_frame.yaw, direction)});
  }
  return readings;
}

struct Place {
  explicit Place(double strength_uT) : field(7, strength_uT) {
    for (int i = 0; i < 30; ++i)
      variogram.add(driven(field, {0.0, 3.0 * i}, 0.0, 20.0, {}, {0, 0, 0}, Random(i)));
  }
  WavyField field;
  FieldVariogram variogram;
};

TEST(FieldVariogram, GrowsFromNothingToTwiceTheFieldsVariance) {
  const Place place(8.0);
  ASSERT_TRUE(place.variogram.is_known());
  EXPECT_LT(place.variogram.squared_difference_uT2(0.02), 2.0);
  EXPECT_LT(place.variogram.squared_difference_uT2(0.3), place.variogram.squared_difference_uT2(1.0));
  EXPECT_NEAR(place.variogram.unrelated_uT2(), 2 * 8.0 * 8.0, 0.4 * 2 * 64);
  EXPECT_FALSE(FieldVariogram().is_known());
}

TEST(FieldEvidence, KnowsThePlaceInEitherDirectionWhateverTheBias) {
  const Place place(8.0);
  const Pose2 building_T_a{1, 2, 0.4}, building_T_b{5.5, 40.2, -2.0};
  const Pose2 a_T_b = between(building_T_a, building_T_b);
  const Eigen::Vector3d bias(8, -6, 5);
  const auto older = driven(place.field, {2, 40}, 0.0, 8, building_T_a, bias, Random(1));
  for (const double direction : {0.0, kPi}) {
    const Eigen::Vector2d from = direction == 0.0 ? Eigen::Vector2d(3, 40.1) : Eigen::Vector2d(8, 40.1);
    const auto newer = driven(place.field, from, direction, 4, building_T_b, bias, Random(2));
    EXPECT_GT(field_evidence(older, newer, a_T_b, place.variogram).log_ratio, 7.0) << direction;
    // The same drive taken for one of another place, with the same geometry.
    const auto elsewhere = driven(place.field, from + Eigen::Vector2d(0, 30), direction, 4,
                                  Pose2{5.5, 70.2, -2.0}, bias, Random(3));
    EXPECT_LT(field_evidence(older, elsewhere, a_T_b, place.variogram).log_ratio, -5.0) << direction;
  }
}

TEST(FieldEvidence, AnotherSensorsBiasIsNotTakenForAnotherPlace) {
  const Place place(8.0);
  const auto older = driven(place.field, {2, 40}, 0.0, 8, {}, {8, -6, 5}, Random(1));
  const auto newer = driven(place.field, {3, 40}, 0.0, 4, {}, {-5, 4, -7}, Random(2));
  FieldEvidenceOptions options;
  EXPECT_LT(field_evidence(older, newer, {}, place.variogram, options).log_ratio, 0.0);
  options.one_bias = false;
  EXPECT_GT(field_evidence(older, newer, {}, place.variogram, options).log_ratio, 5.0);
}

TEST(FieldEvidence, AFieldTooSmallToTellTellsNothing) {
  const Place place(0.2);
  const auto older = driven(place.field, {2, 40}, 0.0, 8, {}, {0, 0, 0}, Random(1));
  const auto there = driven(place.field, {3, 40}, 0.0, 4, {}, {0, 0, 0}, Random(2));
  const auto elsewhere = driven(place.field, {3, 70}, 0.0, 4, {3, 30, 0}, {0, 0, 0}, Random(3));
  EXPECT_NEAR(field_evidence(older, there, {}, place.variogram).log_ratio, 0.0, 1.0);
  EXPECT_NEAR(field_evidence(older, elsewhere, {}, place.variogram).log_ratio, 0.0, 1.0);
}

TEST(FieldEvidence, NothingToCompareTellsNothing) {
  const Place place(8.0);
  const auto older = driven(place.field, {2, 40}, 0.0, 8, {}, {0, 0, 0}, Random(1));
  EXPECT_EQ(field_evidence(older, {}, {}, place.variogram).log_ratio, 0.0);
  EXPECT_EQ(field_evidence({}, older, {}, place.variogram).log_ratio, 0.0);
  EXPECT_EQ(field_evidence(older, older, {100, 0, 0}, place.variogram).log_ratio, 0.0);
  EXPECT_EQ(field_evidence(older, older, {}, FieldVariogram()).log_ratio, 0.0);
}

}  // namespace
}  // namespace mstsl
