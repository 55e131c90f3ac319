#include <algorithm>
#include <functional>

#include <gtest/gtest.h>
#include <zlib.h>

#include "bag_support.hpp"
#include "fuzz/targets.hpp"
#include "io/ros/decode.hpp"
#include "message_support.hpp"
#include "mutations.hpp"

/// Small good files, damaged in many ways, go through every log reader. A reader that crashes or breaks a law
/// of fuzz/targets.cpp ends this program; under the sanitizers so does one that reads out of bounds.
namespace mstsl::test {
namespace {

using Target = void (*)(io::ByteView);

/// Cuts at a stride, random damage, and every field that could be a length set to huge and to slightly wrong
/// values.
void damage(const std::string& good, int count, Target target) {
  const auto feed = [target](const std::string& bytes) { target(io::as_bytes(bytes)); };
  feed(good);
  for_each_damage(good, count, Random(11), feed);
  const std::size_t step = good.size() / static_cast<std::size_t>(count) + 1;
  for (std::size_t at = 0; at + 4 <= good.size(); at += step) {
    for (const char* length :
         {"\xFF\xFF\xFF\xFF", "\xFF\xFF\xFF\x7F", "\x00\x00\x00\x01", "\x01\x00\x00\x00"}) {
      std::string bad = good;
      std::copy_n(length, 4, bad.begin() + static_cast<std::ptrdiff_t>(at));
      feed(bad);
    }
  }
}

std::string small_mcap() {
  const TemporaryFolder folder;
  Random random(3);
  write_log(folder.path() / "log.mcap", random_drive(random, 0.3, 8), survey_topics());
  return read_bytes(folder.path() / "log.mcap");
}

/// The same without compression, so that damage reaches the messages themselves.
std::string plain_mcap() {
  using namespace io::mcap;
  io::ByteBuilder chunk;
  const auto channel = [&chunk](std::uint16_t id, const std::string& topic, const char* type) {
    append(chunk, Schema{id, io::ros::ros2_type_name(type), "ros2msg", ""});
    append(chunk, Channel{id, id, topic, "cdr", {}});
  };
  channel(1, "/odom", io::ros::Odometry::kType);
  channel(2, "/imu/mag", io::ros::MagneticField::kType);
  channel(3, "/scan", io::ros::LaserScan::kType);
  channel(4, "/tf_static", io::ros::TFMessage::kType);
  const auto message = [&chunk](std::uint16_t id, std::uint64_t time, const io::Bytes& data) {
    append(chunk, Message{id, 0, time, time, data});
  };
  io::ros::TFMessage mountings;
  mountings.transforms = {ros_transform("base_link", "laser", {}),
                          ros_transform("base_link", "imu_link", {})};
  message(4, 1'000'000'000, io::ros::encode_cdr(mountings));
  for (int i = 0; i < 3; ++i) {
    const double stamp_s = 1.0 + 0.1 * i;
    const std::uint64_t time = 1'000'000'000 + 100'000'000 * static_cast<std::uint64_t>(i);
    message(1, time, io::ros::encode_cdr(ros_odometry(stamp_s, stamp_s)));
    message(2, time, io::ros::encode_cdr(ros_field(stamp_s)));
    message(3, time, io::ros::encode_cdr(ros_scan(stamp_s, 5)));
  }
  io::ByteBuilder out;
  out.append(io::as_bytes(kMagic));
  append(out, Header{"ros2", "test"});
  append(out, Chunk{0, 0, chunk.bytes().size(), 0, "", chunk.bytes().size(), chunk.bytes()});
  append_data_end(out, 0);
  append(out, Footer{});
  out.append(io::as_bytes(kMagic));
  return std::string(io::as_text(out.bytes()));
}

std::string small_bag() {
  BagBuilder bag({true, true});
  bag.connect(0, "/odom", io::ros::Odometry::kType);
  bag.connect(1, "/scan", io::ros::LaserScan::kType);
  for (int i = 0; i < 4; ++i) {
    // ROS 1 has the same fields behind a sequence number; its bytes are not what matters here.
    const io::Bytes odometry = io::ros::encode_cdr(ros_odometry(1.0 + i));
    bag.write(0, Stamp::from_seconds(1.0 + i), io::as_text(odometry));
    bag.write(1, Stamp::from_seconds(1.0 + i), std::string(60, '\0'));
    bag.end_chunk();
  }
  return bag.finish();
}

std::string small_carmen() {
  std::string log;
  for (int i = 0; i < 5; ++i) {
    const std::string pose = std::to_string(0.1 * i) + " 0.2 0.3";
    log += "ODOM " + pose + " 0 0 0 " + std::to_string(i + 1) + " h 1\n";
    log += "FLASER 4 1 2 3 4 " + pose + " " + pose + " " + std::to_string(i + 1) + " h 1\nODOM " + pose +
           " 0 0 0 0 h 0\n";
  }
  return log;
}

std::string gzip(const std::string& text) {
  const TemporaryFolder folder;
  const auto path = (folder.path() / "packed").string();
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  return read_bytes(path);
}

/// A target aborts on a broken law; coming back from all of them is the assertion that can fail.
struct Case {
  const char* name;
  std::function<std::string()> good;
  int count;
  Target target;
};

class Damaged : public testing::TestWithParam<Case> {};

TEST_P(Damaged, FilesNeverHarmTheirReader) {
  const std::string good = GetParam().good();
  ASSERT_GT(good.size(), 100U);
  damage(good, GetParam().count, GetParam().target);
  SUCCEED();
}

std::string scan_bytes() { return std::string(io::as_text(io::ros::encode_cdr(ros_scan(1.0, 20)))); }

std::string mountings_bytes() {
  io::ros::TFMessage message;
  message.transforms = {ros_transform("a", "b", {1, 2, 3}), ros_transform("c", "d", {4, 5, 6})};
  return std::string(io::as_text(io::ros::encode_cdr(message)));
}

std::string metadata() {
  return "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  relative_file_paths:\n   "
         " - a.mcap\n"
         "  compression_mode: \"\"\n  topics_with_message_count:\n    - message_count: 3\n";
}

INSTANTIATE_TEST_SUITE_P(
    Logs, Damaged,
    testing::Values(Case{"Scan", scan_bytes, 400, try_ros_messages},
                    Case{"Transforms", mountings_bytes, 400, try_ros_messages},
                    Case{"PackedMcap", small_mcap, 300, try_mcap},
                    Case{"PlainMcap", plain_mcap, 1000, try_mcap}, Case{"Bag", small_bag, 1000, try_bag},
                    Case{"PlayedMcap", plain_mcap, 150, try_play},
                    Case{"PlayedBag", small_bag, 100, try_play},
                    Case{"Carmen", small_carmen, 100, try_carmen},
                    Case{"PackedCarmen", [] { return gzip(small_carmen()); }, 60, try_play},
                    Case{"Rosbag2Metadata", metadata, 100, try_rosbag2_metadata}),
    [](const auto& damaged) { return std::string(damaged.param.name); });

}  // namespace
}  // namespace mstsl::test
