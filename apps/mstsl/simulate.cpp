#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/datasets/dataset_writer.hpp"
#include "mstsl/datasets/simulated.hpp"
#include "mstsl/io/map_server.hpp"

#include "interrupt.hpp"
#include "progress.hpp"
#include "session.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kWorldStream = 1, kDataStream = 2;

struct SimulateWish {
  std::string world;
  fs::path base_map;
  fs::path output;
  sim::WorldOptions building;
  datasets::SimulatedOptions data;
  std::array<double, 2> size_m{};
  std::array<double, 3> tilt_deg{};
  double inclination_deg = degrees(sim::EarthField{}.inclination_rad);
  double north_deg = degrees(sim::EarthField{}.north_rad);
  double drift_deg_per_m = degrees(sim::OdometryOptions{}.drift_sigma_rad_per_m);
};

void add_world_options(CLI::App& command, SimulateWish& wish) {
  CLI::Option_group* which = command.add_option_group("World", "one of these");
  which->add_option("--world", wish.world, "A built-in world")->check(CLI::IsMember(sim::world_names()));
  which->add_option("--base-map", wish.base_map, "Walls from a map_server map: its yaml file");
  which->require_option(1);
  sim::WorldOptions& building = wish.building;
  command.add_option("--size", wish.size_m, "Length and width of a built-in world in m")
      ->delimiter(',')
      ->check(CLI::Range(5.0, 500.0));
  command.add_option("--inclination", wish.inclination_deg, "Of the Earth's field below the horizontal, deg")
      ->capture_default_str()
      ->check(CLI::Range(-90.0, 90.0));
  command.add_option("--north", wish.north_deg, "Yaw of magnetic north in the map, deg")
      ->capture_default_str()
      ->check(CLI::Range(-360.0, 360.0));
  command.add_option("--earth-uT", building.earth.strength_uT, "Strength of the Earth's field")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  command
      .add_option("--magnetisation", building.magnetisation,
                  "Factor on the steel's remanence; 1 is realistic")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  command
      .add_option("--moved", wish.data.moved_fraction,
                  "Share of cars, cupboards, goods changed between survey and runs")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
}

void add_survey_options(CLI::App& command, SimulateWish& wish) {
  sim::SurveyOptions& survey = wish.data.survey;
  command.add_option("--lane-spacing", survey.lane_spacing_m, "Between the survey's parallel lines, m")
      ->capture_default_str()
      ->check(CLI::Range(0.05, 20.0));
  CLI::Option* passes =
      command.add_option("--passes", survey.passes, "How often each line is driven both ways")
          ->capture_default_str()
          ->check(CLI::Range(1, 1000));
  command
      .add_option("--fingerprints", survey.fingerprints,
                  "Drive until the survey has so many, one each 5 cm; 0: one pass")
      ->excludes(passes)
      ->check(CLI::Range(0, 10'000'000));
  command
      .add_option("--survey-scan-hz", wish.data.survey_scan_hz,
                  "Scans a second in the surveys' logs; 0 for none")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
}

void add_run_options(CLI::App& command, SimulateWish& wish) {
  command.add_option("--runs", wish.data.runs, "How many runs to be localized")
      ->capture_default_str()
      ->check(CLI::Range(0, 100'000));
  command.add_option("--run-length", wish.data.run.length_m, "Length of a run in m")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 10'000.0));
  command.add_flag(
      "--turn-to-wall,!--no-turn-to-wall", wish.data.turn_to_wall,
      "Begin runs with a turn in place until parallel to the wall that the first scan shows (default)");
}

void add_robot_options(CLI::App& command, SimulateWish& wish) {
  sim::RobotOptions& robot = wish.data.robot;
  command
      .add_option("--bias-sigma-uT", robot.magnetometer.bias_sigma_uT,
                  "SD of the magnetometer's constant error, per log and axis")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1000.0));
  command.add_option("--noise-uT", robot.magnetometer.noise_uT, "SD of the magnetometer's white noise")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1000.0));
  command
      .add_option("--motor-uT", robot.magnetometer.motor_uT_per_m_s,
                  "Field of each drive motor at the sensor at 1 m/s")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1000.0));
  command.add_option("--tilt", wish.tilt_deg, "Roll, pitch and yaw of the magnetometer on the robot, deg")
      ->delimiter(',')
      ->check(CLI::Range(-180.0, 180.0));
  command
      .add_option("--odometry-scale", robot.odometry.scale_sigma, "SD of the odometry's relative scale error")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 0.5));
  command.add_option("--odometry-drift", wish.drift_deg_per_m, "SD of the odometry's drift, deg per m")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 90.0));
  command.add_option("--speed", robot.motion.speed_m_s, "In m/s")
      ->capture_default_str()
      ->check(CLI::Range(0.05, 2.0));
  command.add_option("--scan-hz", robot.lidar.rate_hz, "Scans a second in the runs' logs")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 100.0));
  command.add_option("--people", robot.people.per_100m, "People walking about, per 100 m of lane")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
}

void convert_units(SimulateWish& wish) {
  wish.building.size_m = {wish.size_m[0], wish.size_m[1]};
  wish.building.earth.inclination_rad = radians(wish.inclination_deg);
  wish.building.earth.north_rad = radians(wish.north_deg);
  wish.data.robot.rig =
      sim::tilted_rig({radians(wish.tilt_deg[0]), radians(wish.tilt_deg[1]), radians(wish.tilt_deg[2])});
  wish.data.robot.odometry.drift_sigma_rad_per_m = radians(wish.drift_deg_per_m);
}

Result<sim::World> build(const SimulateWish& wish, const Random& random) {
  if (wish.base_map.empty()) return sim::make_world(wish.world, wish.building, random);
  const auto map = io::read_map_file(wish.base_map);
  if (!map) return map.error();
  for (const std::string& warning : map->warnings) fmt::print(stderr, "mstsl: {}\n", warning);
  auto world = sim::world_from_map(map->grid, wish.building, random);
  if (!world) return world.error().within(wish.base_map.string());
  return world;
}

void report(const Session& session, const SimulateWish& wish, const datasets::Dataset& dataset) {
  if (session.json) {
    const nlohmann::ordered_json summary = {{"folder", wish.output.string()},
                                            {"map", (wish.output / "map.yaml").string()},
                                            {"surveys", dataset.surveys.size()},
                                            {"runs", dataset.runs.size()},
                                            {"seed", session.seed}};
    fmt::print("{}\n", summary.dump());
  } else if (!session.quiet) {
    fmt::print("{}: map.yaml, {} surveys, {} runs with their truth, README.txt\n", wish.output.string(),
               dataset.surveys.size(), dataset.runs.size());
  }
}

Result<Exit> simulate(const Session& session, SimulateWish wish) {
  convert_units(wish);
  const Random random(session.seed);
  const auto world = build(wish, random.fork(kWorldStream));
  if (!world) return world.error();
  if (world->plan().ground) wish.data.map_resolution_m = world->plan().ground->geometry().resolution_m;
  const auto dataset = datasets::simulated(*world, wish.data, random.fork(kDataStream));
  if (!dataset) return dataset.error();
  Progress progress("writing logs", session.quiet);
  const auto show = [&](double share) { return progress.show(share), !interrupted(); };
  if (const auto written = datasets::write_dataset(*dataset, wish.output, show); !written)
    return written.error();
  report(session, wish, *dataset);
  return Exit::kDone;
}

}  // namespace

void add_simulate(CLI::App& app, Session& session) {
  auto wish = std::make_shared<SimulateWish>();
  CLI::App* command =
      app.add_subcommand("simulate", "Make a building, survey its field, and record runs in it");
  add_world_options(*command, *wish);
  command
      ->add_option("-o,--output", wish->output, "Folder for map.yaml, survey_*, run_*, truth_*, README.txt")
      ->required();
  add_survey_options(*command, *wish);
  add_run_options(*command, *wish);
  add_robot_options(*command, *wish);
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return simulate(session, *wish); }; });
}

}  // namespace mstsl::app
