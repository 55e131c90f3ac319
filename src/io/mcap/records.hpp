#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/bytes.hpp"

/// The records of the MCAP container, format version 0 (mcap.dev/spec): each is an opcode, its content's
/// length in 64 bits, and the content. All numbers are little-endian; times are nanoseconds since the Unix
/// epoch.
namespace mstsl::io::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

inline constexpr std::uint64_t kRecordHeadSize = 9;  ///< opcode and length
inline constexpr std::uint64_t kFooterSize = kRecordHeadSize + 20;
inline constexpr std::uint64_t kDataEndSize = kRecordHeadSize + 4;

struct Header {
  std::string profile, library;
};

struct Footer {
  std::uint64_t summary_start = 0, summary_offset_start = 0;  ///< offsets in the file, 0: there is none
  std::uint32_t summary_crc = 0;                              ///< 0: not given
};

struct Schema {
  std::uint16_t id = 0;
  std::string name, encoding;
  std::string data;
};

struct Channel {
  std::uint16_t id = 0, schema_id = 0;
  std::string topic, message_encoding;
  std::map<std::string, std::string> metadata;
};

struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;
  ByteView data;
};

struct Chunk {
  std::uint64_t start_time = 0, end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: not given
  std::string_view compression;
  std::uint64_t records_size = 0;  ///< as promised; `records` is shorter where the file ends in the middle
  ByteView records;
};

struct MessageIndex {
  std::uint16_t channel_id = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>>
      entries;  ///< log time, offset in the uncompressed chunk
};

struct ChunkIndex {
  std::uint64_t start_time = 0, end_time = 0;
  std::uint64_t chunk_offset = 0, chunk_size = 0;
  std::map<std::uint16_t, std::uint64_t> message_index_offsets{};  ///< channels with messages in the chunk
  std::uint64_t message_index_size = 0;
  std::string compression;
  std::uint64_t compressed_size = 0, uncompressed_size = 0;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0, attachment_count = 0, metadata_count = 0, chunk_count = 0;
  std::uint64_t start_time = 0, end_time = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};

struct SummaryOffset {
  Opcode group = Opcode::kSchema;
  std::uint64_t group_start = 0, group_size = 0;
};

/// The record in the content that lies behind its opcode and length; nothing when it is shorter than it must
/// be.
std::optional<Footer> parse_footer(ByteView content);
std::optional<Schema> parse_schema(ByteView content);
std::optional<Channel> parse_channel(ByteView content);
std::optional<Message> parse_message(ByteView content);
std::optional<ChunkIndex> parse_chunk_index(ByteView content);
std::optional<Statistics> parse_statistics(ByteView content);
/// `content` may end in the middle of the chunk's records.
std::optional<Chunk> parse_chunk(ByteView content);

/// Appends the whole record, opcode and length included.
void append(ByteBuilder& out, const Header& record);
void append(ByteBuilder& out, const Footer& record);
void append(ByteBuilder& out, const Schema& record);
void append(ByteBuilder& out, const Channel& record);
void append(ByteBuilder& out, const Message& record);
void append(ByteBuilder& out, const Chunk& record);
void append(ByteBuilder& out, const MessageIndex& record);
void append(ByteBuilder& out, const ChunkIndex& record);
void append(ByteBuilder& out, const Statistics& record);
void append(ByteBuilder& out, const SummaryOffset& record);
void append_data_end(ByteBuilder& out, std::uint32_t data_crc);

}  // namespace mstsl::io::mcap
