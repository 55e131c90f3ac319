#include <algorithm>
#include <utility>

#include "io/mcap/records.hpp"

namespace mstsl::io::mcap {
namespace {

/// A map is preceded by its size in bytes.
template <typename ReadEntry>
void read_entries(ByteCursor& in, ReadEntry read_entry) {
  const ByteView bytes = in.sized<std::uint32_t>();
  ByteCursor entries(bytes);
  while (entries.remaining() > 0) read_entry(entries);
  if (!entries.ok()) in.fail();
}

std::map<std::uint16_t, std::uint64_t> read_counts(ByteCursor& in) {
  std::map<std::uint16_t, std::uint64_t> counts;
  read_entries(in, [&counts](ByteCursor& entry) {
    const auto key = entry.number<std::uint16_t>();
    counts[key] = entry.number<std::uint64_t>();
  });
  return counts;
}

template <typename Record>
std::optional<Record> if_whole(const ByteCursor& in, Record record) {
  if (!in.ok()) return std::nullopt;
  return record;
}

}  // namespace

std::optional<Footer> parse_footer(ByteView content) {
  ByteCursor in(content);
  Footer footer;
  footer.summary_start = in.number<std::uint64_t>();
  footer.summary_offset_start = in.number<std::uint64_t>();
  footer.summary_crc = in.number<std::uint32_t>();
  return if_whole(in, footer);
}

std::optional<Schema> parse_schema(ByteView content) {
  ByteCursor in(content);
  Schema schema;
  schema.id = in.number<std::uint16_t>();
  schema.name = in.text();
  schema.encoding = in.text();
  schema.data = as_text(in.sized<std::uint32_t>());
  return if_whole(in, std::move(schema));
}

std::optional<Channel> parse_channel(ByteView content) {
  ByteCursor in(content);
  Channel channel;
  channel.id = in.number<std::uint16_t>();
  channel.schema_id = in.number<std::uint16_t>();
  channel.topic = in.text();
  channel.message_encoding = in.text();
  read_entries(in, [&channel](ByteCursor& entry) {
    std::string key(entry.text());
    channel.metadata[std::move(key)] = entry.text();
  });
  return if_whole(in, std::move(channel));
}

std::optional<Message> parse_message(ByteView content) {
  ByteCursor in(content);
  Message message;
  message.channel_id = in.number<std::uint16_t>();
  message.sequence = in.number<std::uint32_t>();
  message.log_time = in.number<std::uint64_t>();
  message.publish_time = in.number<std::uint64_t>();
  message.data = in.take(in.remaining());
  return if_whole(in, message);
}

std::optional<Chunk> parse_chunk(ByteView content) {
  ByteCursor in(content);
  Chunk chunk;
  chunk.start_time = in.number<std::uint64_t>();
  chunk.end_time = in.number<std::uint64_t>();
  chunk.uncompressed_size = in.number<std::uint64_t>();
  chunk.uncompressed_crc = in.number<std::uint32_t>();
  chunk.compression = in.text();
  chunk.records_size = in.number<std::uint64_t>();
  chunk.records = in.take(std::min<std::uint64_t>(chunk.records_size, in.remaining()));
  return if_whole(in, chunk);
}

std::optional<ChunkIndex> parse_chunk_index(ByteView content) {
  ByteCursor in(content);
  ChunkIndex index;
  index.start_time = in.number<std::uint64_t>();
  index.end_time = in.number<std::uint64_t>();
  index.chunk_offset = in.number<std::uint64_t>();
  index.chunk_size = in.number<std::uint64_t>();
  index.message_index_offsets = read_counts(in);
  index.message_index_size = in.number<std::uint64_t>();
  index.compression = in.text();
  index.compressed_size = in.number<std::uint64_t>();
  index.uncompressed_size = in.number<std::uint64_t>();
  return if_whole(in, std::move(index));
}

std::optional<Statistics> parse_statistics(ByteView content) {
  ByteCursor in(content);
  Statistics statistics;
  statistics.message_count = in.number<std::uint64_t>();
  statistics.schema_count = in.number<std::uint16_t>();
  statistics.channel_count = in.number<std::uint32_t>();
  statistics.attachment_count = in.number<std::uint32_t>();
  statistics.metadata_count = in.number<std::uint32_t>();
  statistics.chunk_count = in.number<std::uint32_t>();
  statistics.start_time = in.number<std::uint64_t>();
  statistics.end_time = in.number<std::uint64_t>();
  statistics.channel_message_counts = read_counts(in);
  return if_whole(in, std::move(statistics));
}

}  // namespace mstsl::io::mcap
