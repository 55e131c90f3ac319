#include "mstsl/eval/ambiguity.hpp"

#include <numeric>

#include <gtest/gtest.h>

#include "../localize/hand_made_world.hpp"

namespace mstsl {
namespace {

using test::HandMadeWorld;
using test::must;

AmbiguityOptions few() {
  AmbiguityOptions options;
  options.spacing_m = 3.0;
  options.drives = 1;
  return options;
}

int sum_of(const std::vector<AmbiguousPlace>& places, int AmbiguousPlace::*what) {
  return std::accumulate(places.begin(), places.end(), 0,
                         [&](int sum, const AmbiguousPlace& p) { return sum + p.*what; });
}

/// The same building with next to no field: half a turn of it looks almost the same.
std::shared_ptr<const LocalizationMaps> without_field(const HandMadeWorld& world) {
  FieldMap flat = world.field_map();
  for (Eigen::Vector3f& cell : flat.mean_uT)
    if (!cell.hasNaN()) cell = Eigen::Vector3f(3, 20, -43);
  return must(make_localization_maps(world.map, std::move(flat)));
}

TEST(Ambiguity, AFieldThatDiffersEverywhereMakesPlacesKnown) {
  const HandMadeWorld world;
  const auto places = must(find_ambiguity(world.maps, few()));
  EXPECT_GT(places.size(), 8U);
  EXPECT_EQ(sum_of(places, &AmbiguousPlace::wrong), 0);
  EXPECT_GT(sum_of(places, &AmbiguousPlace::right), sum_of(places, &AmbiguousPlace::drives) / 2);
  for (const AmbiguousPlace& p : places) {
    EXPECT_LE(p.right + p.wrong, p.drives);
    EXPECT_FALSE(HandMadeWorld::solid(p.place_m)) << p.place_m.transpose();
  }
}

TEST(Ambiguity, WithoutAFieldFewerAreAnsweredAndNoneWrongly) {
  const HandMadeWorld world;
  const auto with = must(find_ambiguity(world.maps, few())),
             without = must(find_ambiguity(without_field(world), few()));
  EXPECT_LT(sum_of(without, &AmbiguousPlace::right), sum_of(with, &AmbiguousPlace::right));
  EXPECT_EQ(sum_of(without, &AmbiguousPlace::wrong), 0);
}

TEST(Ambiguity, IsTheSameAtAnyNumberOfThreads) {
  const HandMadeWorld world;
  AmbiguityOptions one = few(), four = few();
  one.threads = Threads{1}, four.threads = Threads{4};
  const auto a = must(find_ambiguity(world.maps, one)), b = must(find_ambiguity(world.maps, four));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].right, b[i].right);
    EXPECT_EQ(a[i].field_known, b[i].field_known);
  }
}

TEST(Ambiguity, EndsWhenAskedTo) {
  const HandMadeWorld world;
  AmbiguityOptions options = few();
  options.progress = [](double) { return false; };
  EXPECT_FALSE(find_ambiguity(world.maps, options).ok());
}

}  // namespace
}  // namespace mstsl
