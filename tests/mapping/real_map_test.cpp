#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/mapping/occupancy_mapper.hpp"
#include "mstsl/scan/match_submap.hpp"

#include "test_support.hpp"

/// Maps of real buildings from real scans and their corrected poses (CARMEN logs), and real scans matched to
/// them.
namespace mstsl {
namespace {

struct PosedScan {
  LaserScan scan;
  Pose2 map_T_base;
};

struct Recording {
  Rig rig;
  std::vector<PosedScan> scans;
};

Recording read(const std::string& name) {
  Recording recording;
  std::map<Stamp, Pose2> poses;
  std::vector<LaserScan> scans;
  io::PlayOptions options;
  options.topics.pose = "/corrected_pose";
  test::must(io::play(
      {test::data_file(name)}, options,
      [&](const io::RecordingHeader& header) { recording.rig = header.rig; },
      [&](const SensorEvent& event) {
        if (const auto* pose = std::get_if<PoseReading>(&event)) poses[pose->stamp] = pose->map_T_base;
        if (const auto* scan = std::get_if<LaserScan>(&event)) scans.push_back(*scan);
        return true;
      }));
  for (const LaserScan& scan : scans) {
    if (poses.contains(scan.stamp)) recording.scans.push_back({scan, poses.at(scan.stamp)});
  }
  return recording;
}

OccupancyGrid map_of(const Recording& recording, std::size_t first, std::size_t step) {
  OccupancyMapper mapper;
  for (std::size_t i = first; i < recording.scans.size(); i += step) {
    test::must(
        mapper.insert(recording.scans[i].scan, recording.rig.base_T_laser, recording.scans[i].map_T_base));
  }
  return mapper.grid();
}

/// Half of the scans draw the map; of the others each tenth is matched to it from a start that is off.
void expect_scans_match_the_map(const std::string& name, double median_error_m, double median_score) {
  const Recording recording = read(name);
  ASSERT_GT(recording.scans.size(), 400U);
  const MatchMap map(map_of(recording, 0, 2));
  Random random(1);
  std::vector<double> errors_m, scores;
  for (std::size_t i = 1; i < recording.scans.size(); i += 20) {
    const auto& [scan, truth] = recording.scans[i];
    const PointSet points = points_in_base(scan, recording.rig.base_T_laser);
    const Pose2 start = truth * Pose2{random.normal(0, 0.2), random.normal(0, 0.2), random.normal(0, 0.05)};
    const auto match =
        match_submap(map, thinned(points, 0.1), points, PosePrior::isotropic(start, 0.2, 0.05));
    errors_m.push_back(match ? distance(match->refined.map_T_base, truth) : 1.0);
    scores.push_back(match ? match->confidence : 0.0);
  }
  std::ranges::sort(errors_m);
  std::ranges::sort(scores);
  EXPECT_LT(errors_m[errors_m.size() / 2], median_error_m);
  EXPECT_GT(scores[scores.size() / 2], median_score);
}

TEST(RealMap, OfAcesFitsItsOwnScans) {
  MSTSL_REQUIRE_DATA("carmen/aces-corrected.log.gz");
  expect_scans_match_the_map("carmen/aces-corrected.log.gz", 0.05, kConfidenceThreshold);
}

TEST(RealMap, OfIntelFitsItsOwnScans) {
  MSTSL_REQUIRE_DATA("carmen/intel-corrected.log.gz");
  expect_scans_match_the_map("carmen/intel-corrected.log.gz", 0.05, kConfidenceThreshold);
}

}  // namespace
}  // namespace mstsl
