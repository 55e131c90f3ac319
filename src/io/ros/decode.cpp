#include "io/ros/decode.hpp"

#include <utility>

#include "io/ros/archives.hpp"

namespace mstsl::io::ros {
namespace {

template <typename Layout, typename Message>
std::optional<Message> read_as(ByteView bytes) {
  Reader<Layout> reader(bytes);
  Message message;
  reader(message);
  if (!reader.ok()) return std::nullopt;
  return message;
}

}  // namespace

template <typename Message>
std::optional<Message> decode(Encoding encoding, ByteView bytes) {
  if (encoding == Encoding::kCdr) return read_as<CdrLayout, Message>(bytes);
  if (encoding == Encoding::kRos1) return read_as<Ros1Layout, Message>(bytes);
  return std::nullopt;
}

template <typename Message>
Bytes encode_cdr(Message message) {
  CdrWriter writer;
  writer(message);
  return writer.bytes();
}

#define MSTSL_ROS_MESSAGE(Message)                                     \
  template std::optional<Message> decode<Message>(Encoding, ByteView); \
  template Bytes encode_cdr<Message>(Message);

MSTSL_ROS_MESSAGE(LaserScan)
MSTSL_ROS_MESSAGE(MagneticField)
MSTSL_ROS_MESSAGE(Imu)
MSTSL_ROS_MESSAGE(Odometry)
MSTSL_ROS_MESSAGE(PoseStamped)
MSTSL_ROS_MESSAGE(PoseWithCovarianceStamped)
MSTSL_ROS_MESSAGE(TFMessage)

}  // namespace mstsl::io::ros
