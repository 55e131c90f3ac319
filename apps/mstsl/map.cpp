#include <memory>

#include <CLI/CLI.hpp>

#include "calibration_option.hpp"
#include "map_ambiguity.hpp"
#include "map_magnetic.hpp"
#include "map_occupancy.hpp"
#include "map_update.hpp"
#include "session.hpp"
#include "topic_options.hpp"

namespace mstsl::app {
namespace {

void add_map_magnetic(CLI::App& map, Session& session) {
  auto wish = std::make_shared<MagneticMapWish>();
  wish->play.topics.imu.clear();
  CLI::App* command = map.add_subcommand("magnetic", "Make a magnetic field map from the logs of a survey");
  command->add_option("--map", wish->map, "Occupancy map: a map_server yaml")->required();
  auto* poses = command->add_option_group("poses", "Where the robot was during the survey");
  poses->add_option("--pose-topic", wish->play.topics.pose, "Topic with the robot's poses in the map");
  poses->add_option(
      "--initial-pose", wish->initial_pose,
      "X,Y,YAW (m, rad) at the start of each log, to about 1 m and 20 deg: where the robot went from "
      "there is then found from scans and odometry");
  poses->require_option(1);
  command->add_option("--model", wish->model, "How the field between the fingerprints is made")
      ->check(CLI::IsMember({"gpr", "bilinear", "fingerprint"}))
      ->capture_default_str();
  command
      ->add_option("--kernel", wish->kernel,
                   "What gpr assumes of the field: se, three independent squared exponentials; harmonic, the "
                   "gradient of a potential; auto, what foretells held-out lanes better")
      ->check(CLI::IsMember({"se", "harmonic", "auto"}))
      ->capture_default_str();
  command
      ->add_option("--quality", wish->quality,
                   "Of the regression: fast (mean within 4 % of the noise) or exact (1 %)")
      ->check(CLI::IsMember({"fast", "exact"}))
      ->capture_default_str();
  command
      ->add_option("--bias", wish->bias,
                   "A magnetometer bias seen between opposite passes: remove where significant (auto), "
                   "always, or keep")
      ->check(CLI::IsMember({"auto", "remove", "keep"}))
      ->capture_default_str();
  add_calibration_option(*command, wish->calibration);
  command->add_option("--resolution", wish->build.resolution_m, "Side of a cell, m")
      ->check(CLI::Range(0.005, 10.0))
      ->capture_default_str();
  command->add_option("--field-topic", wish->play.topics.magnetic_field, "MagneticField messages")
      ->capture_default_str()
      ->group("Names in the log");
  command->add_option("--scan-topic", wish->play.topics.scan, "LaserScan messages (with --initial-pose)")
      ->capture_default_str()
      ->group("Names in the log");
  command
      ->add_option("--odometry-topic", wish->play.topics.odometry, "Odometry messages (with --initial-pose)")
      ->capture_default_str()
      ->group("Names in the log");
  command
      ->add_option("--tf-topic", wish->play.topics.transforms_static,
                   "TFMessage messages with the sensors' mounting")
      ->capture_default_str()
      ->group("Names in the log");
  command->add_option("--base-frame", wish->play.base_frame, "Frame of the robot's base")
      ->capture_default_str()
      ->group("Names in the log");
  command->add_option(
      "--check", wish->checks,
      "Logs of other drives, with poses too: how well the map foretells their field (it is not "
      "made from them)");
  command->add_option("--picture", wish->picture,
                      "Also a picture of it, PNG or SVG: components, strength, standard deviation, coverage");
  command->add_option("-o,--output", wish->output, "Field map, NetCDF")->required();
  command->add_option("logs", wish->logs, "MCAP, rosbag2 folder or ROS 1 bag; each is a session of its own")
      ->required();
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return map_magnetic(session, *wish); }; });
}

void add_drive_options(CLI::App& command, DrivesWish& wish) {
  command.add_flag(
      "--continuous", wish.continuous,
      "Each log begins where the one before ended; otherwise each is a drive of its own, which is found in "
      "the map of those before it");
  command.add_flag("--no-field", wish.without_field,
                   "Leave the magnetic field out: loops are closed by scans alone");
  command.add_option(
      "--truth-topic", wish.truth_topic,
      "Topic with true poses: how far the drives' are from them is said, and nothing else done with "
      "them");
  command.add_option("--resolution", wish.drawing.resolution_m, "Side of a cell of the occupancy map, m")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  add_topic_options(command, wish.play);
  command.add_option("logs", wish.logs, "MCAP, rosbag2 folder, ROS 1 bag or CARMEN log")->required();
}

void add_map_occupancy(CLI::App& map, Session& session) {
  auto wish = std::make_shared<OccupancyMapWish>();
  CLI::App* command = map.add_subcommand(
      "occupancy", "Make an occupancy map from the logs of drives through a building that is not known");
  command->add_option("-o,--output", wish->output, "Occupancy map: a map_server yaml, its image beside it")
      ->required();
  command->add_option("--tum", wish->tum, "Also where the robot was, in TUM format");
  command->add_option("--report", wish->report, "Also what was found, as JSON: loops, wheels, drives");
  command->add_option("--picture", wish->picture, "Also a picture of map and way, PNG or SVG");
  add_drive_options(*command, wish->drives);
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return map_occupancy(session, *wish); }; });
}

void add_map_all(CLI::App& map, Session& session) {
  auto wish = std::make_shared<WholeMapWish>();
  CLI::App* command = map.add_subcommand(
      "all", "Make both maps, of walls and of the magnetic field, from raw logs of drives");
  command
      ->add_option("-o,--output", wish->folder,
                   "Folder for map.yaml, field.nc, trajectory.tum, report.json, pictures")
      ->required();
  add_drive_options(*command, wish->drives);
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return map_all(session, *wish); }; });
}

void add_map_update(CLI::App& map, Session& session) {
  auto wish = std::make_shared<UpdateWish>();
  CLI::App* command = map.add_subcommand(
      "update",
      "Bring a field map up to date with newer drives: where the building changed, they replace what was "
      "measured; elsewhere both count");
  command->add_option("--map", wish->map, "Occupancy map: a map_server yaml")->required();
  command->add_option("--field", wish->field, "Field map to be brought up to date, NetCDF")->required();
  command->add_option("-o,--output", wish->output,
                      "The new field map; may be the old one's name. Without it changes are only reported");
  command->add_option("--picture", wish->picture, "Also a picture of what changed where, PNG or SVG");
  auto* poses = command->add_option_group(
      "poses", "Where the robot was; without either the joint method finds it on the maps");
  poses->add_option("--pose-topic", wish->play.topics.pose, "Topic with the robot's poses in the map");
  poses->add_option("--initial-pose", wish->initial_pose, "X,Y,YAW (m, rad) at the start of each log");
  poses->require_option(0, 1);
  add_calibration_option(*command, wish->calibration);
  add_topic_options(*command, wish->play);
  command
      ->add_option("logs", wish->logs,
                   "MCAP, rosbag2 folder or ROS 1 bag of about one time; for a later day run it again")
      ->required();
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return map_update(session, *wish); }; });
}

void add_map_ambiguity(CLI::App& map, Session& session) {
  auto wish = std::make_shared<AmbiguityWish>();
  CLI::App* command = map.add_subcommand(
      "ambiguity",
      "Say from the maps alone where a robot that is switched on will soon find itself, and where not");
  command->add_option("--map", wish->map, "Occupancy map: a map_server yaml")->required();
  command->add_option("--field", wish->field, "Field map, NetCDF")->required();
  command->add_option("-o,--output", wish->output, "The places and what became of their drives, JSON");
  command->add_option("--picture", wish->picture, "The map, coloured by it, PNG or SVG");
  command->add_option("--spacing", wish->options.spacing_m, "Between the places, m")
      ->check(CLI::Range(0.2, 50.0))
      ->capture_default_str();
  command->add_option("--drive", wish->options.drive_m, "Driven from each place, m")
      ->check(CLI::Range(0.5, 50.0))
      ->capture_default_str();
  command->add_option("--drives", wish->options.drives, "From each place, in different directions")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return map_ambiguity(session, *wish); }; });
}

}  // namespace

void add_map(CLI::App& app, Session& session) {
  CLI::App* map = app.add_subcommand("map", "Make maps from the logs of a survey");
  map->require_subcommand(1);
  add_map_magnetic(*map, session);
  add_map_occupancy(*map, session);
  add_map_all(*map, session);
  add_map_update(*map, session);
  add_map_ambiguity(*map, session);
}

}  // namespace mstsl::app
