#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mstsl/core/stamp.hpp"

#include "io/bytes.hpp"
#include "io/input_file.hpp"

/// The records of ROS 1 bags, format version 2.0 (wiki.ros.org/Bags/Format/2.0): each is a header of
/// name=value fields and data, both preceded by their size in 32 bits. All numbers are little-endian.
namespace mstsl::io::bag {

inline constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
inline constexpr std::string_view kAnyMagic = "#ROSBAG V";

enum class Op : std::uint8_t {
  kNone = 0x00,
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

/// The fields of a record's header. A view: it looks into the bytes it was parsed from, since most records
/// are small messages and each has one.
class Fields {
 public:
  /// Nothing when a field goes past the end or has no name.
  static std::optional<Fields> parse(ByteView bytes);

  /// The value of the first field of that name, empty when there is none.
  std::string_view text(std::string_view name) const;
  template <Number T>
  std::optional<T> number(std::string_view name) const {
    const std::string_view bytes = text(name);
    if (bytes.size() != sizeof(T)) return std::nullopt;
    return ByteCursor(as_bytes(bytes)).number<T>();
  }
  Op op() const { return static_cast<Op>(number<std::uint8_t>("op").value_or(0)); }

 private:
  explicit Fields(ByteView bytes) : bytes_(bytes) {}
  ByteView bytes_;
};

struct Connection {
  std::uint32_t id = 0;
  std::string topic, type;
};

struct Message {
  std::uint32_t connection = 0;
  Stamp time;
  ByteView data;
};

struct Chunk {
  std::string_view compression;
  std::uint32_t uncompressed_size = 0;
};

struct ChunkInfo {
  std::uint64_t position = 0;
  Stamp first, last;
  std::map<std::uint32_t, std::uint32_t> message_counts;  ///< by connection
};

/// Where the index of the bag lies; 0: it was never written.
std::optional<std::uint64_t> parse_index_position(const Fields& fields);
std::optional<Connection> parse_connection(const Fields& fields, ByteView data);
std::optional<Message> parse_message(const Fields& fields, ByteView data);
std::optional<Chunk> parse_chunk(const Fields& fields);
std::optional<ChunkInfo> parse_chunk_info(const Fields& fields, ByteView data);

/// Calls `visit(fields, data)` for the whole records in `bytes`; false where they end in the middle of one.
template <typename Visit>
bool for_each_record(ByteView bytes, Visit visit) {
  ByteCursor in(bytes);
  while (in.remaining() > 0) {
    const ByteView header = in.sized<std::uint32_t>();
    const ByteView data = in.sized<std::uint32_t>();
    const std::optional<Fields> fields = in.ok() ? Fields::parse(header) : std::nullopt;
    if (!fields) return false;
    visit(*fields, data);
  }
  return true;
}

}  // namespace mstsl::io::bag
