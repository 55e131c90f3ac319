#include "mstsl/magnetic/field_update.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"

#include "hand_made_survey.hpp"
#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;

/// A room surveyed once, into which a steel cupboard may then be carried.
struct Room {
  test::SurveyPlan plan{.width_m = 10.0, .height_m = 6.0};
  Random random{7};
  test::WavyField field{1.0, 6.0, random};
  FieldMap map = made_of(test::drive(field, plan, random), {{"survey.mcap", Stamp{0}, Stamp{1}}});

  /// Made once: learning takes its time.
  static const Room& surveyed() {
    static const Room room;
    return room;
  }

  static FieldMap made_of(const std::vector<Fingerprint>& fingerprints, std::vector<SurveyDrive> drives) {
    FieldMapOptions options{.resolution_m = 0.1, .analysis = {.kernel = KernelChoice::kSquaredExponential}};
    options.drives = std::move(drives);
    return must(build_field_map(fingerprints, nullptr, options));
  }

  /// The cupboard's field: a point dipole that stands upright.
  static Eigen::Vector3d cupboard(const Eigen::Vector2d& at_m, const Eigen::Vector2d& p) {
    constexpr double kAbove_m = 0.6, kMoment = 12.0;
    const Eigen::Vector3d r(p.x() - at_m.x(), p.y() - at_m.y(), -kAbove_m);
    const double d = r.norm();
    return kMoment * (3.0 * r * (r.z() / (d * d)) - Eigen::Vector3d::UnitZ()) / (d * d * d);
  }

  /// Another day's drive along one lane between those of the survey and back.
  std::vector<Fingerprint> later_drive(double y_m, const Eigen::Vector3d& base_bias_uT) {
    std::vector<Fingerprint> drive;
    for (const double heading : {0.0, kPi})
      for (int i = 10; i < 190; ++i) {
        const double x = heading == 0.0 ? 0.05 * i : 10.0 - 0.05 * i;
        Fingerprint f{{x, y_m}, field.at({x, y_m}), heading, 1};
        f.field_uT += f.map_R_base() * base_bias_uT;
        for (int c = 0; c < 3; ++c) f.field_uT(c) += random.normal(0, plan.noise_uT);
        drive.push_back(f);
      }
    return drive;
  }
};

TEST(FieldUpdate, WhereNothingChangedNothingIsReplacedAndTheBiasIsFound) {
  Room room = Room::surveyed();
  const Eigen::Vector3d bias(2.0, -3.0, 1.5);
  const FieldUpdate update = must(update_survey(room.map, room.later_drive(2.25, bias)));
  ASSERT_EQ(update.drives.size(), 1U);
  EXPECT_LT((update.drives[0].base_bias_uT - bias).norm(), 0.3);
  EXPECT_TRUE(update.drives[0].changes.empty());
  EXPECT_EQ(update.replaced_now, 0U);
  EXPECT_EQ(update.fingerprints.size(), room.map.fingerprints.size() + update.added);
  EXPECT_EQ(update.added + update.confirming, 360U);
  EXPECT_NEAR(update.drives[0].compared_m + update.drives[0].new_m, 2 * 8.95, 0.1);
}

TEST(FieldUpdate, WhatACupboardChangedIsReplacedAndTheNewMapIsRight) {
  Room room = Room::surveyed();
  const Eigen::Vector2d cupboard_m(5.0, 2.7);
  std::vector<Fingerprint> drive = room.later_drive(2.25, Eigen::Vector3d(0.5, 0.5, 0.0));
  for (Fingerprint& f : drive) f.field_uT += Room::cupboard(cupboard_m, f.position_m);
  const FieldUpdate update = must(update_survey(room.map, drive));
  ASSERT_EQ(update.drives[0].changes.size(), 2U) << "there and back";
  for (const FieldChange& change : update.drives[0].changes)
    EXPECT_LT((change.center_m - Eigen::Vector2d(5.0, 2.25)).norm(), 0.5);
  EXPECT_GT(update.replaced_now, 50U);
  for (const ReplacedFingerprint& r : update.replaced) {
    EXPECT_EQ(r.by_session, 1);
    EXPECT_LT((r.fingerprint.position_m - cupboard_m).norm(), 3.0);
  }
  EXPECT_EQ(update.replaced.size() + update.fingerprints.size(), room.map.fingerprints.size() + update.added);

  const FieldMap updated = Room::made_of(
      update.fingerprints, {{"survey.mcap", Stamp{0}, Stamp{1}}, {"later.mcap", Stamp{2}, Stamp{3}}});
  const auto rms = [&](const FieldMap& map) {
    double sum = 0.0;
    int count = 0;
    for (double x = 4.2; x <= 5.8; x += 0.1, ++count) {
      const Eigen::Vector2d p(x, 2.25);
      const Eigen::Vector3d truth = room.field.at(p) + Room::cupboard(cupboard_m, p);
      sum += (map.at(p)->mean_uT - truth).squaredNorm() / 3.0;
    }
    return std::sqrt(sum / count);
  };
  EXPECT_LT(rms(updated), 0.25 * rms(room.map));
  const Cell beside = updated.geometry.cell_at({5.0, 2.25}), corner = updated.geometry.cell_at({1.0, 5.8});
  EXPECT_EQ(updated.newest_drive[updated.geometry.index(beside)], 1);
  EXPECT_EQ(updated.newest_drive[updated.geometry.index(corner)], 0);
}

TEST(FieldUpdate, DrivenEveryDayTheMapDoesNotGrow) {
  Room room = Room::surveyed();
  FieldUpdate update = must(update_survey(room.map, room.later_drive(2.02, {1.0, 0.0, 0.0})));
  EXPECT_EQ(update.added, 0U) << "along a lane of the survey";
  EXPECT_EQ(update.fingerprints.size(), room.map.fingerprints.size());
  // Away from all lanes there is something to learn, once.
  std::vector<Fingerprint> beside = room.later_drive(6.4, {1.0, 0.0, 0.0});
  std::vector<Fingerprint> along = room.later_drive(5.9, {1.0, 0.0, 0.0});
  along.insert(along.end(), beside.begin(), beside.end());
  update = must(update_survey(room.map, along));
  EXPECT_GT(update.added, 50U);
  FieldMap second = room.map;
  second.fingerprints = update.fingerprints;
  for (Fingerprint& f : along) f.position_m.y() += 0.01;
  EXPECT_EQ(must(update_survey(second, along)).added, 0U);
}

TEST(FieldUpdate, ConfirmationCountsAsHavingBeenThere) {
  Room room = Room::surveyed();
  FieldMap made = room.map;
  made.drives.push_back({"later.mcap", Stamp{2}, Stamp{3}});
  const std::vector<std::int32_t> newest =
      newest_drives(made, room.map, room.later_drive(2.0, {0.0, 0.0, 0.0}));
  EXPECT_EQ(newest[made.geometry.index(made.geometry.cell_at({5.0, 2.0}))], 1);
  EXPECT_EQ(newest[made.geometry.index(made.geometry.cell_at({5.0, 5.5}))], 0);
  // And is remembered by the map made from that one.
  FieldMap later = made;
  later.newest_drive = newest;
  EXPECT_EQ(newest_drives(made, later, {}), newest);
}

TEST(FieldUpdate, ADriveOfAnotherBuildingIsRefused) {
  Room room = Room::surveyed();
  Random random(8);
  const test::WavyField elsewhere(1.0, 6.0, random);
  std::vector<Fingerprint> drive = room.later_drive(2.25, Eigen::Vector3d::Zero());
  for (Fingerprint& f : drive) f.field_uT = elsewhere.at(f.position_m);
  const auto update = update_survey(room.map, drive);
  ASSERT_FALSE(update);
  EXPECT_NE(update.error().message().find("contradicts the map nearly everywhere"), std::string::npos);
  // With another that does not, it is left out.
  std::vector<Fingerprint> both = drive;
  for (Fingerprint& f : both) f.session = 2;
  const std::vector<Fingerprint> good = room.later_drive(2.25, Eigen::Vector3d::Zero());
  both.insert(both.begin(), good.begin(), good.end());
  const FieldUpdate without = must(update_survey(room.map, both));
  ASSERT_EQ(without.drives.size(), 2U);
  EXPECT_TRUE(without.drives[0].refused.empty());
  EXPECT_EQ(without.drives[1].session, 2);
  EXPECT_FALSE(without.drives[1].refused.empty());
  EXPECT_EQ(without.replaced_now, 0U);
  for (const Fingerprint& f : without.fingerprints) EXPECT_NE(f.session, 2);
}

TEST(FieldUpdate, ADriveBesideTheMapIsRefusedAndSoIsAMapWithoutItsSurvey) {
  Room room = Room::surveyed();
  std::vector<Fingerprint> drive = room.later_drive(2.25, Eigen::Vector3d::Zero());
  FieldMap bare = room.map;
  bare.fingerprints.clear();
  EXPECT_FALSE(update_survey(bare, drive));
  EXPECT_FALSE(update_survey(room.map, {}));
  FieldMap guessed = room.map;  // values, but nothing surveyed to be held against
  std::ranges::fill(guessed.supported, std::uint8_t{0});
  EXPECT_FALSE(update_survey(guessed, drive));
  for (Fingerprint& f : drive) f.position_m.x() += 100.0;
  const auto update = update_survey(room.map, drive);
  ASSERT_FALSE(update);
  EXPECT_NE(update.error().message().find("does not come near"), std::string::npos);
}

}  // namespace
}  // namespace mstsl
