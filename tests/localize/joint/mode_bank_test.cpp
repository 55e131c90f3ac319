#include "mstsl/localize/joint/mode_bank.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "../hand_made_world.hpp"

namespace mstsl::joint {
namespace {

constexpr double kStep_m = 0.12;

/// A robot that drives east in the southern corridor, its laser blind, and what a bank of two places makes of
/// it: the right one, and one in the northern corridor.
class TwoPlaces {
 public:
  explicit TwoPlaces(const BankOptions& options) : bank_(make_maps(world_.maps), {0, 0}, options) {
    bank_.add({truth_, {4.0, 9.0, 0.0}}, 0.02, 0.01);
  }

  /// Drives on; the field is the map's, or, as if steel had been moved, that of the northern corridor.
  void drive(double way_m, bool moved) {
    for (double driven_m = 0.0; driven_m < way_m; driven_m += kStep_m) {
      truth_ = truth_ * Pose2{kStep_m, 0, 0};
      const Eigen::Vector2d place = truth_.position() + Eigen::Vector2d(0, moved ? 8.0 : 0.0);
      Step step;
      step.last_T_base = {kStep_m, 0, 0};
      step.stations = {
          {.base_field_uT = world_.field_uT(place), .variance_uT2 = 0.01, .since_last_m = kStep_m}};
      bank_.advance(step);
    }
  }

  double right_weight() const {
    double sum = 0.0;
    for (const Mode& mode : bank_.modes())
      if (distance(mode.map_T_base, truth_) < 0.5) sum += std::exp(mode.log_weight);
    return sum;
  }
  double sum() const {
    double sum = bank_.elsewhere_share();
    for (const Mode& mode : bank_.modes()) sum += std::exp(mode.log_weight);
    return sum;
  }

 private:
  test::HandMadeWorld world_;
  Pose2 truth_{4.0, 1.0, 0.0};
  ModeBank bank_;
};

TEST(ModeBank, TwoMetresOfMovedSteelDoNotRefuteAPlace) {
  BankOptions as_before;
  as_before.early_loss = 1e6;
  TwoPlaces spared({}), refuted(as_before);
  for (TwoPlaces* places : {&spared, &refuted}) places->drive(2.0, true);
  EXPECT_LT(refuted.right_weight(), 1e-8);
  EXPECT_GT(spared.right_weight(), 2e-5);
  EXPECT_LT(spared.right_weight(), 1e-3) << "it must not keep the other from being claimed at 0.999";
  spared.drive(3.0, false);
  EXPECT_GT(spared.right_weight(), 0.99);
  EXPECT_NEAR(spared.sum(), 1.0, 1e-9);
}

TEST(ModeBank, ThirteenMetresDo) {
  TwoPlaces places({});
  places.drive(13.0, true);
  EXPECT_LT(places.right_weight(), 1e-6);
}

}  // namespace
}  // namespace mstsl::joint
