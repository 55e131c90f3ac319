#include "io/bag/index.hpp"

#include <algorithm>
#include <utility>

#include "io/bag/record_stream.hpp"

namespace mstsl::io::bag {
namespace {

/// rosbag's chunks are 768 kB unless told otherwise; both sides hold a whole one in memory.
constexpr std::uint32_t kLargestChunk = std::uint32_t{1} << 30;

void widen(Index& index, Stamp first, Stamp last) {
  index.first = index.first ? std::min(*index.first, first) : first;
  index.last = index.last ? std::max(*index.last, last) : last;
}

void add(Index& index, ChunkInfo info) {
  for (const auto& [connection, count] : info.message_counts) index.message_counts[connection] += count;
  widen(index, info.first, info.last);
  index.chunks.try_emplace(info.position, std::move(info));
}

}  // namespace

std::optional<Index> read_index(const InputFile& file) {
  RecordStream stream(file, kMagic.size());
  const std::optional<Record> header = stream.next();
  const std::optional<std::uint64_t> position = header ? parse_index_position(header->fields) : std::nullopt;
  const auto connection_count = header ? header->fields.number<std::uint32_t>("conn_count") : std::nullopt;
  const auto chunk_count = header ? header->fields.number<std::uint32_t>("chunk_count") : std::nullopt;
  if (!position || *position < kMagic.size() || *position > file.size()) return std::nullopt;

  Index index;
  stream.seek(*position);
  while (const std::optional<Record> record = stream.next()) {
    const ByteView data = stream.load(*record);
    if (data.size() < record->data_size) break;
    if (record->fields.op() == Op::kConnection) {
      if (auto connection = parse_connection(record->fields, data))
        index.connections.try_emplace(connection->id, std::move(*connection));
    } else if (record->fields.op() == Op::kChunkInfo) {
      if (auto info = parse_chunk_info(record->fields, data)) add(index, std::move(*info));
    }
  }
  const bool whole = index.connections.size() == connection_count && index.chunks.size() == chunk_count;
  if (!whole) return std::nullopt;
  return index;
}

Index scan_index(const InputFile& file) {
  Index index;
  const auto take = [&index](const Fields& fields, ByteView data) {
    if (fields.op() == Op::kConnection) {
      if (auto connection = parse_connection(fields, data))
        index.connections.try_emplace(connection->id, std::move(*connection));
    } else if (fields.op() == Op::kMessage) {
      const std::optional<Message> message = parse_message(fields, data);
      if (!message) return;
      ++index.message_counts[message->connection];
      widen(index, message->time, message->time);
    }
  };
  Decompressor decompressor;
  RecordStream stream(file, kMagic.size());
  while (const std::optional<Record> record = stream.next()) {
    const Op op = record->fields.op();
    if (op != Op::kChunk && op != Op::kConnection && op != Op::kMessage) continue;
    const ByteView data = stream.load(*record);
    if (op == Op::kChunk)
      for_each_record(unpack(record->fields, data, decompressor).bytes, take);
    else if (data.size() == record->data_size)
      take(record->fields, data);
  }
  return index;
}

Decompressor::Output unpack(const Fields& fields, ByteView data, Decompressor& decompressor) {
  const std::optional<Chunk> chunk = parse_chunk(fields);
  if (!chunk || chunk->uncompressed_size > kLargestChunk) return {};
  return decompressor.decompress(chunk->compression, data, chunk->uncompressed_size);
}

}  // namespace mstsl::io::bag
