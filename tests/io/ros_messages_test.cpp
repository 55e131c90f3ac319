#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"

#include "io/ros/decode.hpp"
#include "io/ros/schemas.hpp"

namespace mstsl::io::ros {
namespace {

Bytes bytes_of(std::initializer_list<int> values) {
  Bytes bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

/// The bytes of 1.5, -2.0 and 0.25 as 64-bit numbers are these, most significant first.
constexpr std::initializer_list<int> kX{0x3F, 0xF8, 0, 0, 0, 0, 0, 0};
constexpr std::initializer_list<int> kY{0xC0, 0, 0, 0, 0, 0, 0, 0};
constexpr std::initializer_list<int> kZ{0x3F, 0xD0, 0, 0, 0, 0, 0, 0};

void append(Bytes& out, std::initializer_list<int> values, bool reversed) {
  Bytes piece = bytes_of(values);
  if (reversed) std::ranges::reverse(piece);
  out.insert(out.end(), piece.begin(), piece.end());
}

/// A MagneticField with stamp 7.000000009 s and frame "mag" by the words of the CDR standard.
Bytes field_by_hand(bool little) {
  Bytes out = bytes_of({0, little ? 1 : 0, 0, 0});
  append(out, {0, 0, 0, 7}, little);
  append(out, {0, 0, 0, 9}, little);
  append(out, {0, 0, 0, 4}, little);  // the closing zero counts
  append(out, {'m', 'a', 'g', 0}, false);
  append(out, kX, little);  // 16 bytes after the encapsulation: aligned as it is
  append(out, kY, little);
  append(out, kZ, little);
  for (int i = 0; i < 9; ++i) append(out, {0, 0, 0, 0, 0, 0, 0, 0}, little);
  return out;
}

void expect_field_by_hand(const std::optional<MagneticField>& field) {
  ASSERT_TRUE(field.has_value());
  EXPECT_EQ(field->header.stamp.sec, 7);
  EXPECT_EQ(field->header.stamp.nanosec, 9U);
  EXPECT_EQ(field->header.frame_id, "mag");
  EXPECT_EQ(field->magnetic_field.x, 1.5);
  EXPECT_EQ(field->magnetic_field.y, -2.0);
  EXPECT_EQ(field->magnetic_field.z, 0.25);
}

TEST(Cdr, ReadsBothByteOrders) {
  expect_field_by_hand(decode<MagneticField>(Encoding::kCdr, field_by_hand(true)));
  expect_field_by_hand(decode<MagneticField>(Encoding::kCdr, field_by_hand(false)));
}

TEST(Cdr, IsWrittenAsTheStandardSays) {
  MagneticField field;
  field.header = {{7, 9}, "mag"};
  field.magnetic_field = {1.5, -2.0, 0.25};
  EXPECT_EQ(encode_cdr(field), field_by_hand(true));
}

TEST(Cdr, AlignsNumbersToTheirSizeAfterTheEncapsulation) {
  MagneticField field;
  field.header.frame_id = "imu";  // 4 bytes with the zero: the vector begins at 16
  const auto short_name = encode_cdr(field).size();
  field.header.frame_id = "imu_";  // 5 bytes: padded to 24
  EXPECT_EQ(encode_cdr(field).size(), short_name + 8);
  field.header.frame_id = "imu_link678";  // 12 bytes: begins at 24 as well
  EXPECT_EQ(encode_cdr(field).size(), short_name + 8);
  EXPECT_EQ(decode<MagneticField>(Encoding::kCdr, encode_cdr(field))->header.frame_id, "imu_link678");
}

TEST(Cdr, RefusesOtherEncapsulations) {
  Bytes parameter_list = field_by_hand(true);
  parameter_list[1] = std::byte{3};
  EXPECT_FALSE(decode<MagneticField>(Encoding::kCdr, parameter_list).has_value());
  EXPECT_FALSE(decode<MagneticField>(Encoding::kCdr, {}).has_value());
}

TEST(Cdr, TakesSecondsBeforeTheEpochAsNegative) {
  Odometry odometry;
  odometry.header.stamp = {-5, 1};
  EXPECT_EQ(decode<Odometry>(Encoding::kCdr, encode_cdr(odometry))->header.stamp.sec, -5);
}

/// ROS 1 packs without padding and puts a sequence number before each stamp.
TEST(Ros1, ReadsPackedMessages) {
  Bytes out;
  append(out, {0, 0, 1, 2}, true);              // sequence number
  append(out, {0xFF, 0xFF, 0xFF, 0xFF}, true);  // the last second that ROS 1 knows, in 2106
  append(out, {0, 0, 0, 9}, true);
  append(out, {0, 0, 0, 3}, true);
  append(out, {'m', 'a', 'g'}, false);
  append(out, kX, true);
  append(out, kY, true);
  append(out, kZ, true);
  for (int i = 0; i < 9; ++i) append(out, kZ, true);
  const auto field = decode<MagneticField>(Encoding::kRos1, out);
  ASSERT_TRUE(field.has_value());
  EXPECT_EQ(field->header.stamp.sec, 4294967295);
  EXPECT_EQ(field->header.frame_id, "mag");
  EXPECT_EQ(field->magnetic_field.y, -2.0);
  EXPECT_EQ(field->magnetic_field_covariance[8], 0.25);
}

LaserScan random_scan(Random& random) {
  LaserScan scan;
  scan.header = {
      {static_cast<std::int64_t>(random.index(1000)), static_cast<std::uint32_t>(random.index(1000))},
      std::string(random.index(20), 'f')};
  scan.angle_increment = static_cast<float>(random.normal());
  for (std::size_t i = random.index(50); i > 0; --i)
    scan.ranges.push_back(static_cast<float>(random.normal()));
  for (std::size_t i = random.index(50); i > 0; --i)
    scan.intensities.push_back(static_cast<float>(random.normal()));
  return scan;
}

TEST(Cdr, GivesBackWhatWasWritten) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const LaserScan scan = random_scan(random);
    const auto read = decode<LaserScan>(Encoding::kCdr, encode_cdr(scan));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->header.frame_id, scan.header.frame_id);
    EXPECT_EQ(read->angle_increment, scan.angle_increment);
    EXPECT_EQ(read->ranges, scan.ranges);
    EXPECT_EQ(read->intensities, scan.intensities);
  }
}

TEST(Cdr, NestedMessagesComeBack) {
  TFMessage message;
  message.transforms = {{{{1, 2}, "a"}, "b", {1.0, 2.0, 3.0}, {0.0, 0.0, 1.0, 0.0}},
                        {{{3, 4}, "long frame name"}, "", {4.0, 5.0, 6.0}, {}}};
  const auto read = decode<TFMessage>(Encoding::kCdr, encode_cdr(message));
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->transforms.size(), 2U);
  EXPECT_EQ(read->transforms[0].child_frame_id, "b");
  EXPECT_EQ(read->transforms[1].header.frame_id, "long frame name");
  EXPECT_EQ(read->transforms[1].translation.z, 6.0);
  EXPECT_EQ(read->transforms[1].rotation.w, 1.0);
}

template <typename Message>
void expect_no_prefix_is_whole(const Message& message) {
  const Bytes whole = encode_cdr(message);
  ASSERT_TRUE(decode<Message>(Encoding::kCdr, whole).has_value());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode<Message>(Encoding::kCdr, ByteView(whole).first(size)).has_value())
        << size << " bytes";
}

TEST(Decoding, RefusesMessagesCutAnywhere) {
  Random random(2);
  expect_no_prefix_is_whole(random_scan(random));
  expect_no_prefix_is_whole(Odometry{});
  expect_no_prefix_is_whole(Imu{});
  expect_no_prefix_is_whole(PoseStamped{});
  expect_no_prefix_is_whole(PoseWithCovarianceStamped{});
  TFMessage message;
  message.transforms.resize(3);
  expect_no_prefix_is_whole(message);
}

/// Were a length believed, these would ask for up to 16 GiB (and the sanitizer's limit would end the test).
TEST(Decoding, BelievesNoLengthBeforeItsBytesAreThere) {
  for (const Encoding encoding : {Encoding::kCdr, Encoding::kRos1}) {
    for (std::size_t place = 0; place < 60; ++place) {
      Bytes bytes = encode_cdr(LaserScan{});
      for (std::size_t i = place; i < std::min(place + 4, bytes.size()); ++i) bytes[i] = std::byte{0xFF};
      EXPECT_LT(decode<LaserScan>(encoding, bytes).value_or(LaserScan{}).ranges.size(), bytes.size());
      EXPECT_LT(decode<TFMessage>(encoding, bytes).value_or(TFMessage{}).transforms.size(), bytes.size());
    }
  }
}

TEST(Decoding, KnowsNoOtherEncoding) {
  EXPECT_FALSE(decode<Imu>(Encoding::kOther, encode_cdr(Imu{})).has_value());
}

TEST(Schemas, HoldEveryDefinitionOnceBehindALineOfEqualSigns) {
  const std::string schema = ros2msg_schema(Odometry::kType);
  const std::string separator = std::string(80, '=') + "\nMSG: ";
  EXPECT_TRUE(schema.starts_with("std_msgs/Header header\n"));
  for (const char* type :
       {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/PoseWithCovariance",
        "geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Quaternion",
        "geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist", "geometry_msgs/Vector3"}) {
    const std::string start = separator + type + "\n";
    const std::size_t first = schema.find(start);
    ASSERT_NE(first, std::string::npos) << type;
    EXPECT_EQ(schema.find(start, first + 1), std::string::npos) << type;
  }
  EXPECT_EQ(ros2msg_schema("my_msgs/Unknown"), "");
}

TEST(Schemas, NameTypesAsEitherRosDoes) {
  EXPECT_EQ(ros2_type_name("sensor_msgs/LaserScan"), "sensor_msgs/msg/LaserScan");
  EXPECT_EQ(plain_type_name("sensor_msgs/msg/LaserScan"), "sensor_msgs/LaserScan");
  EXPECT_EQ(plain_type_name("sensor_msgs/LaserScan"), "sensor_msgs/LaserScan");
}

}  // namespace
}  // namespace mstsl::io::ros
