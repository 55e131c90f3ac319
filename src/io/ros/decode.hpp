#pragma once

#include <optional>

#include "io/bytes.hpp"
#include "io/ros/messages.hpp"

namespace mstsl::io::ros {

/// How a message is laid out in bytes.
enum class Encoding {
  kCdr,    ///< ROS 2: plain CDR of either byte order, behind its 4-byte encapsulation header
  kRos1,   ///< ROS 1: packed little-endian
  kOther,  ///< something that is not read here
};

/// The message in `bytes`, or nothing when a length or the whole is not what it must be. No length is
/// believed before the bytes that it promises are there, so hostile ones allocate nothing. Defined for every
/// message struct of messages.hpp that has a type name.
template <typename Message>
std::optional<Message> decode(Encoding encoding, ByteView bytes);

/// The message as ROS 2 writes it: little-endian CDR.
template <typename Message>
Bytes encode_cdr(Message message);

}  // namespace mstsl::io::ros
