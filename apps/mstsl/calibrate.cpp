#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/io/calibration_file.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/magnetic/turn_calibration.hpp"

#include "interrupt.hpp"
#include "output_paths.hpp"
#include "session.hpp"
#include "topic_options.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

struct CalibrateWish {
  fs::path output;
  std::vector<fs::path> logs;
  io::PlayOptions play;
};

/// The turns of one log after the other, which must have the sensor mounted alike.
Result<TurnCalibration> find_calibration(const Session& session, const CalibrateWish& wish) {
  std::optional<TurnCalibrator> calibrator;
  io::PlayOptions play = wish.play;
  play.topics.scan.clear();
  play.topics.imu.clear();
  const auto on_header = [&](const io::RecordingHeader& header) { calibrator.emplace(header.rig); };
  const auto on_event = [&](const SensorEvent& event) {
    if (!calibrator) return false;
    if (const auto* odometry = std::get_if<OdometryReading>(&event)) calibrator->observe(*odometry);
    if (const auto* field = std::get_if<FieldReading>(&event)) calibrator->observe(*field);
    if (std::holds_alternative<OdometryRestart>(event)) calibrator->restart();
    return !interrupted();
  };
  const Result<io::PlayReport> played = io::play(wish.logs, play, on_header, on_event);
  if (!played) return played.error();
  if (interrupted()) return Error("interrupted; nothing was written");
  if (!session.quiet)
    for (const std::string& warning : played->warnings) fmt::print(stderr, "mstsl: warning: {}\n", warning);
  if (!calibrator)
    return Error(wish.logs.front().string() + ": the log holds no event; nothing to calibrate from");
  Result<TurnCalibration> found = calibrator->finish();
  if (!found) return found.error().within(wish.logs.front().string());
  return found;
}

std::string to_text(const TurnCalibration& found) {
  const Eigen::Vector3d &b = found.calibration.hard_iron_uT, &sd = found.hard_iron_sd_uT;
  std::string text = fmt::format("{} turns on the spot, {} field readings\n", found.turns, found.readings);
  text += fmt::format("hard iron, sensor x y z: {:.2f} {:.2f} {:.2f} +- {:.2f} {:.2f} {:.2f} uT\n", b.x(),
                      b.y(), b.z(), sd.x(), sd.y(), sd.z());
  text += fmt::format("soft iron (+- {:.3f}):\n", found.soft_iron_sd);
  for (int r = 0; r < 3; ++r) {
    const auto row = found.calibration.soft_iron.row(r);
    text += fmt::format("  {:7.4f} {:7.4f} {:7.4f}\n", row(0), row(1), row(2));
  }
  text += fmt::format("horizontal strength over a turn changes by {:.2f} uT rms, calibrated {:.2f} uT\n",
                      found.uncorrected_uT, found.corrected_uT);
  text +=
      "not shown by turning in the plane: hard iron along the axis of rotation (0 assumed), the field's true "
      "strength,\n"
      "what the vertical field induces, a twist of the sensor about the axis\n";
  return text;
}

std::string to_json(const TurnCalibration& found) {
  const auto list = [](const Eigen::Vector3d& v) { return std::array{v.x(), v.y(), v.z()}; };
  nlohmann::ordered_json soft = nlohmann::ordered_json::array();
  for (int r = 0; r < 3; ++r) soft.push_back(list(found.calibration.soft_iron.row(r).transpose()));
  const nlohmann::ordered_json json{{"hard_iron_uT", list(found.calibration.hard_iron_uT)},
                                    {"hard_iron_sd_uT", list(found.hard_iron_sd_uT)},
                                    {"soft_iron", soft},
                                    {"soft_iron_sd", found.soft_iron_sd},
                                    {"turns", found.turns},
                                    {"readings", found.readings},
                                    {"strength_change_uT", found.uncorrected_uT},
                                    {"strength_change_calibrated_uT", found.corrected_uT},
                                    {"warnings", found.warnings}};
  return json.dump() + "\n";
}

Result<Exit> calibrate(const Session& session, const CalibrateWish& wish) {
  if (auto error = overwritten_input({wish.output}, wish.logs)) return *std::move(error);
  const Result<TurnCalibration> found = find_calibration(session, wish);
  if (!found) return found.error();
  if (!session.quiet)
    for (const std::string& warning : found->warnings) fmt::print(stderr, "mstsl: warning: {}\n", warning);
  if (const auto written = io::write_calibration(*found, wish.output); !written) return written.error();
  if (session.json)
    fmt::print("{}", to_json(*found));
  else if (!session.quiet)
    fmt::print("{}written to {}\n", to_text(*found), wish.output.string());
  return Exit::kDone;
}

}  // namespace

void add_calibrate(CLI::App& app, Session& session) {
  auto wish = std::make_shared<CalibrateWish>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Find a magnetometer's hard and soft iron from turns on the spot");
  command
      ->add_option("-o,--output", wish->output, "Calibration, yaml; other commands take it by --calibration")
      ->required();
  command->add_option("logs", wish->logs, "MCAP, rosbag2 folder or ROS 1 bag, with odometry")->required();
  add_topic_options(*command, wish->play);
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return calibrate(session, *wish); }; });
}

}  // namespace mstsl::app
