#include "targets.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "mstsl/io/estimates.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/io/recording_info.hpp"
#include "mstsl/io/truth.hpp"
#include "mstsl/io/tum.hpp"

#include "io/bag/bag_log.hpp"
#include "io/mcap/mcap_log.hpp"
#include "io/ros/decode.hpp"
#include "test_support.hpp"

namespace mstsl::test {
namespace {

namespace fs = std::filesystem;

/// Broken laws end the program, with or without assertions, so that fuzzer and test runner both see them.
void require(bool law) {
  if (!law) std::abort();
}

/// A folder for the whole run: one a call would be slow.
const fs::path& folder() {
  static const TemporaryFolder folder;
  return folder.path();
}

fs::path file_of(io::ByteView bytes, const std::string& name) {
  fs::path path = folder() / name;
  const std::string_view text = io::as_text(bytes);
  std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
  return path;
}

template <typename Message>
void try_message(io::ByteView bytes) {
  for (const auto encoding : {io::ros::Encoding::kCdr, io::ros::Encoding::kRos1}) {
    const std::optional<Message> message = io::ros::decode<Message>(encoding, bytes);
    if (!message) continue;
    const io::Bytes encoded = io::ros::encode_cdr(*message);
    const std::optional<Message> again = io::ros::decode<Message>(io::ros::Encoding::kCdr, encoded);
    require(again.has_value() && io::ros::encode_cdr(*again) == encoded);
  }
}

void try_log(Result<std::unique_ptr<io::MessageLog>> log, std::size_t file_size) {
  if (!log) return;
  const auto wanted = [](const io::Channel&) { return true; };
  const auto visit = [](const io::RawMessage& message) { return message.channel != nullptr; };
  io::PlayReport report;
  (*log)->read(wanted, visit, &report);
  (*log)->read(wanted, visit, nullptr);
  require(report.warnings.size() <= file_size);
}

template <typename Reading>
bool is_finite(const Reading& reading) {
  if constexpr (std::is_same_v<Reading, OdometryReading>) return reading.odom_T_base.is_finite();
  if constexpr (std::is_same_v<Reading, PoseReading>) return reading.map_T_base.is_finite();
  if constexpr (std::is_same_v<Reading, FieldReading>) return reading.sensor_field_uT.allFinite();
  if constexpr (std::is_same_v<Reading, ImuReading>) return reading.angular_velocity_rad_s.allFinite();
  if constexpr (std::is_same_v<Reading, LaserScan>)
    return std::isfinite(reading.angle_min_rad) && std::isfinite(reading.angle_increment_rad) &&
           !reading.ranges_m.empty();
  return true;
}

}  // namespace

void try_ros_messages(io::ByteView bytes) {
  try_message<io::ros::LaserScan>(bytes);
  try_message<io::ros::MagneticField>(bytes);
  try_message<io::ros::Imu>(bytes);
  try_message<io::ros::Odometry>(bytes);
  try_message<io::ros::PoseStamped>(bytes);
  try_message<io::ros::PoseWithCovarianceStamped>(bytes);
  try_message<io::ros::TFMessage>(bytes);
}

void try_mcap(io::ByteView bytes) {
  try_log(io::open_mcap(io::InputFile::in_memory(bytes)), bytes.size() + 1);
}

void try_bag(io::ByteView bytes) { try_log(io::open_bag(io::InputFile::in_memory(bytes)), bytes.size() + 1); }

void try_carmen(io::ByteView bytes) {
  static const std::string start = "PARAM made for a test\n";
  const std::string text = start + std::string(io::as_text(bytes));
  try_play(io::as_bytes(text));
  try_play(bytes);
}

void try_play(io::ByteView bytes) {
  const fs::path path = file_of(bytes, "log");
  std::optional<Stamp> last;
  io::PlayOptions options;
  const auto check = [&last](const SensorEvent& event) {
    const bool restarts = std::holds_alternative<OdometryRestart>(event);
    require(restarts || !last || *last <= stamp_of(event));
    require(std::visit([](const auto& reading) { return is_finite(reading); }, event));
    last = stamp_of(event);
    return true;
  };
  const auto played = io::play({path}, options, {}, check);
  require(played.ok() || !played.error().message().empty());
  options.topics = {
      .scan = "", .magnetic_field = "", .odometry = "/odom", .transforms_static = "", .imu = "", .pose = ""};
  last.reset();
  const auto odometry_only = io::play({path}, options, {}, check);
  require(odometry_only.ok() || !odometry_only.error().message().empty());
  const auto info = io::describe_recording(path);
  require(info.ok() || !info.error().message().empty());
}

void try_rosbag2_metadata(io::ByteView bytes) {
  fs::create_directories(folder() / "bag");
  file_of(bytes, "bag/metadata.yaml");
  const auto info = io::describe_recording(folder() / "bag");
  require(info.ok() || !info.error().message().empty());
}

void try_map_image(io::ByteView bytes) {
  for (const char* name : {"image.pgm", "image.png", "image.bmp"}) {
    file_of(bytes, name);
    const std::string yaml =
        std::string("image: ") + name +
        "\nresolution: 0.05\norigin: [0, 0, 0.1]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    const auto map = io::read_map(file_of(io::as_bytes(yaml), "image.yaml"));
    require(map.ok() || !map.error().message().empty());
  }
}

void try_map_yaml(io::ByteView bytes) {
  file_of(io::as_bytes("P5 2 2 255\nabcd"), "map.pgm");
  const auto map = io::read_map(file_of(bytes, "map.yaml"));
  require(map.ok() || !map.error().message().empty());
}

void try_field_map(io::ByteView bytes) {
  const auto field = io::decode_field_map(io::as_text(bytes), "field.nc");
  require(field.ok() || !field.error().message().empty());
}

void try_text_tables(io::ByteView bytes) {
  const fs::path path = file_of(bytes, "table");
  const auto estimates = io::read_estimates(path);
  const auto tum = io::read_tum(path);
  const auto truth = io::read_truth(path);
  require(estimates.ok() || !estimates.error().message().empty());
  require(tum.ok() || !tum.error().message().empty());
  require(truth.ok() || !truth.error().message().empty());
}

}  // namespace mstsl::test
