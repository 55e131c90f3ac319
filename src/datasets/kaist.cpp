#include "mstsl/datasets/kaist.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/datasets/floor_plan.hpp"
#include "mstsl/datasets/measured_drive.hpp"
#include "mstsl/datasets/number_columns.hpp"
#include "mstsl/datasets/windows.hpp"
#include "mstsl/sim/occupancy_map.hpp"

namespace mstsl::datasets {
namespace {

constexpr std::uint64_t kSurveyStream = 1;
constexpr std::uint64_t kWindowStream = 2;
constexpr std::uint64_t kRunStream = 3;
constexpr std::uint64_t kWayStream = 4;

constexpr double kLaneWidth_m = 1.0;  // the plan's narrowest corridors are 2.1 m wide

using Names = std::array<std::string_view, 5>;

Result<std::vector<Fingerprint>> read_points(const std::filesystem::path& file, const Names& names) {
  const auto columns = read_number_columns(file, names);
  if (!columns) return columns.error();
  std::vector<Fingerprint> points(columns->front().size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].position_m = {(*columns)[0][i], (*columns)[1][i]};
    points[i].field_uT = {(*columns)[2][i], (*columns)[3][i], (*columns)[4][i]};
  }
  return points;
}

sim::World world_of(const FloorPlan& floor, const std::vector<std::vector<Fingerprint>>& lanes) {
  sim::WorldPlan plan;
  plan.name = "kaist-n1-7f";
  plan.walls = walls(floor);
  constexpr double kMargin_m = 1.0;
  for (const Eigen::Vector2d& corner : floor.outer) {
    plan.footprint_m.extend(Eigen::Vector2d(corner.array() - kMargin_m));
    plan.footprint_m.extend(Eigen::Vector2d(corner.array() + kMargin_m));
  }
  for (const std::vector<Fingerprint>& lane : lanes)
    plan.lanes.push_back({{lane.front().position_m, lane.back().position_m}, kLaneWidth_m});
  return sim::World(std::move(plan));
}

sim::RobotOptions holding(sim::RobotOptions robot, const Eigen::Matrix3d& base_R_phone) {
  robot.rig.base_T_magnetometer.linear() = base_R_phone;
  return robot;
}

/// The walk with each half's field turned into the survey's axes, and where the second half begins.
struct TurnedWalk {
  std::vector<Fingerprint> rows;
  std::size_t second_half = 0;

  std::vector<Window> windows(double length_m) const {
    std::vector<Eigen::Vector2d> path_m;
    for (const Fingerprint& row : rows) path_m.push_back(row.position_m);
    std::vector<bool> follows(rows.size(), true);
    follows[second_half] = false;
    return windows_of_length(path_m, follows, length_m);
  }
  std::size_t half_of(const Window& window) const { return window.first < second_half ? 0 : 1; }
};

TurnedWalk turned(const std::array<WalkHalf, 2>& halves) {
  TurnedWalk walk;
  walk.second_half = halves[0].rows.size();
  for (const WalkHalf& half : halves)
    for (Fingerprint row : half.rows) {
      row.field_uT = half.survey_R_phone * row.field_uT;
      walk.rows.push_back(row);
    }
  return walk;
}

std::vector<Fingerprint> stretch(const TurnedWalk& walk, const Window& window, bool backwards) {
  std::vector<Fingerprint> rows(walk.rows.begin() + static_cast<std::ptrdiff_t>(window.first),
                                walk.rows.begin() + static_cast<std::ptrdiff_t>(window.last + 1));
  if (backwards) std::reverse(rows.begin(), rows.end());
  return rows;
}

std::string described(const Eigen::Vector3d& rms_uT) {
  return fmt::format("{:.1f}, {:.1f}, {:.1f} uT", rms_uT.x(), rms_uT.y(), rms_uT.z());
}

std::string described(const WalkHalf& half) {
  const Eigen::AngleAxisd turn(half.survey_R_phone);
  return fmt::format(
      "a turn of {:.1f} deg about ({:.2f}, {:.2f}, {:.2f}); what is left (rms of x, y, z): {}\n"
      "               (with a rotation fitted to this half itself: {})",
      degrees(turn.angle()), turn.axis().x(), turn.axis().y(), turn.axis().z(), described(half.residual_uT),
      described(half.fit.residual_rms));
}

std::string provenance(const KaistOptions& options, const std::array<WalkHalf, 2>& halves, std::size_t points,
                       std::size_t lanes) {
  return fmt::format(R"(Made from canlang/sjlee-s-Robust-Magnetic-Field-Positionig (KAIST N1, 7th floor; MIT).

REAL: the floor plan (walls of N1-7F.json) and the magnetic field. survey_*.mcap hold the {} points of
batch.csv (a lattice of 0.5 m) as {} lanes, with readings only at the surveyed points. run_*.mcap are
stretches of {:.0f} m of the independent walk of sjlee_testdata_N1_20180723.csv, taken either way, with
its raw readings. Each starts with a random heading and turns in place; while it turns, the field is that
of its first row.

FITTED: how the walker held the phone is documented nowhere. base_T_magnetometer of a run is a rotation
fitted to the survey on the half of the walk that the run is not from:
  first half:  {}
  second half: {}
What is left is the survey's and the phone's own error (bias included: none was fitted), the lattice's
coarseness, and the even pace that the walk's positions assume. The survey's axes are taken as the map's;
a turn between them would be the same for survey and runs.

SIMULATED: lidar (UTM-30LX) among the plan's walls, wheel odometry.
Added to the field: bias of {} uT, noise of {} uT (SD per axis).
)",
                     points, lanes, options.runs.length_m, described(halves[0]), described(halves[1]),
                     options.robot.magnetometer.bias_sigma_uT, options.robot.magnetometer.noise_uT);
}

}  // namespace

Result<std::vector<Fingerprint>> read_kaist_survey(const std::filesystem::path& file) {
  return read_points(file, {"x", "y", "magnet_x", "magnet_y", "magnet_z"});
}

Result<std::vector<Fingerprint>> read_kaist_walk(const std::filesystem::path& file) {
  return read_points(file, {"location_x", "location_y", "magnet_x", "magnet_y", "magnet_z"});
}

Result<Dataset> kaist_n1_7f(const std::filesystem::path& folder, const KaistOptions& options,
                            const Random& random) {
  const Result<FloorPlan> floor = read_floor_plan(folder / "N1-7F.json");
  if (!floor) return floor.error();
  const auto survey = read_kaist_survey(folder / "batch.csv");
  if (!survey) return survey.error();
  const auto walk = read_kaist_walk(folder / "sjlee_testdata_N1_20180723.csv");
  if (!walk) return walk.error();
  const auto halves = calibrated_halves(*walk, *survey);
  if (!halves) return halves.error().within(folder.string());
  const auto lanes = lattice_lanes(*survey, options.lattice);
  if (lanes.empty()) return Error(folder.string() + ": the points of batch.csv lie on no lane");
  const TurnedWalk turned_walk = turned(*halves);
  const auto windows = draw_windows(turned_walk.windows(options.runs.length_m), options.runs.count,
                                    random.fork(kWindowStream));
  if (!windows) return windows.error().within(folder.string());
  const auto world = std::make_shared<const sim::World>(world_of(*floor, lanes));

  Dataset dataset;
  dataset.map = sim::occupancy_map(*world, options.map_resolution_m);
  dataset.provenance = provenance(options, *halves, survey->size(), lanes.size());
  for (std::size_t i = 0; i < lanes.size(); ++i)
    dataset.surveys.push_back(
        point_survey(world, lanes[i], options.robot, random.fork(kSurveyStream).fork(i)));
  Random ways = random.fork(kWayStream);
  for (std::size_t i = 0; i < windows->size(); ++i) {
    const Window& window = (*windows)[i];
    const sim::RobotOptions robot =
        holding(options.robot, (*halves)[turned_walk.half_of(window)].survey_R_phone);
    dataset.runs.push_back(measured_run(world, stretch(turned_walk, window, ways.chance(0.5)), robot,
                                        random.fork(kRunStream).fork(i)));
  }
  return dataset;
}

}  // namespace mstsl::datasets
