#include "io/mcap/records.hpp"

namespace mstsl::io::mcap {
namespace {

/// Writes opcode, length and what `write_content` puts into a builder of its own.
template <typename WriteContent>
void append_record(ByteBuilder& out, Opcode opcode, WriteContent write_content) {
  ByteBuilder content;
  write_content(content);
  out.number(static_cast<std::uint8_t>(opcode));
  out.sized<std::uint64_t>(content.bytes());
}

template <typename Key, typename Value, typename WriteEntry>
void append_map(ByteBuilder& out, const std::map<Key, Value>& entries, WriteEntry write_entry) {
  ByteBuilder bytes;
  for (const auto& [key, value] : entries) write_entry(bytes, key, value);
  out.sized<std::uint32_t>(bytes.bytes());
}

void append_counts(ByteBuilder& out, const std::map<std::uint16_t, std::uint64_t>& counts) {
  append_map(out, counts, [](ByteBuilder& bytes, std::uint16_t key, std::uint64_t value) {
    bytes.number(key);
    bytes.number(value);
  });
}

}  // namespace

void append(ByteBuilder& out, const Header& record) {
  append_record(out, Opcode::kHeader, [&](ByteBuilder& content) {
    content.text(record.profile);
    content.text(record.library);
  });
}

void append(ByteBuilder& out, const Footer& record) {
  append_record(out, Opcode::kFooter, [&](ByteBuilder& content) {
    content.number(record.summary_start);
    content.number(record.summary_offset_start);
    content.number(record.summary_crc);
  });
}

void append(ByteBuilder& out, const Schema& record) {
  append_record(out, Opcode::kSchema, [&](ByteBuilder& content) {
    content.number(record.id);
    content.text(record.name);
    content.text(record.encoding);
    content.text(record.data);
  });
}

void append(ByteBuilder& out, const Channel& record) {
  append_record(out, Opcode::kChannel, [&](ByteBuilder& content) {
    content.number(record.id);
    content.number(record.schema_id);
    content.text(record.topic);
    content.text(record.message_encoding);
    append_map(content, record.metadata,
               [](ByteBuilder& bytes, const std::string& key, const std::string& value) {
                 bytes.text(key);
                 bytes.text(value);
               });
  });
}

/// Without the detour over a builder of its own: this one is written for every message.
void append(ByteBuilder& out, const Message& record) {
  out.number(static_cast<std::uint8_t>(Opcode::kMessage));
  out.number(std::uint64_t{22} + record.data.size());
  out.number(record.channel_id);
  out.number(record.sequence);
  out.number(record.log_time);
  out.number(record.publish_time);
  out.append(record.data);
}

void append(ByteBuilder& out, const Chunk& record) {
  append_record(out, Opcode::kChunk, [&](ByteBuilder& content) {
    content.number(record.start_time);
    content.number(record.end_time);
    content.number(record.uncompressed_size);
    content.number(record.uncompressed_crc);
    content.text(record.compression);
    content.sized<std::uint64_t>(record.records);
  });
}

void append(ByteBuilder& out, const MessageIndex& record) {
  append_record(out, Opcode::kMessageIndex, [&](ByteBuilder& content) {
    content.number(record.channel_id);
    content.number(static_cast<std::uint32_t>(record.entries.size() * 16));
    for (const auto& [log_time, offset] : record.entries) {
      content.number(log_time);
      content.number(offset);
    }
  });
}

void append(ByteBuilder& out, const ChunkIndex& record) {
  append_record(out, Opcode::kChunkIndex, [&](ByteBuilder& content) {
    content.number(record.start_time);
    content.number(record.end_time);
    content.number(record.chunk_offset);
    content.number(record.chunk_size);
    append_counts(content, record.message_index_offsets);
    content.number(record.message_index_size);
    content.text(record.compression);
    content.number(record.compressed_size);
    content.number(record.uncompressed_size);
  });
}

void append(ByteBuilder& out, const Statistics& record) {
  append_record(out, Opcode::kStatistics, [&](ByteBuilder& content) {
    content.number(record.message_count);
    content.number(record.schema_count);
    content.number(record.channel_count);
    content.number(record.attachment_count);
    content.number(record.metadata_count);
    content.number(record.chunk_count);
    content.number(record.start_time);
    content.number(record.end_time);
    append_counts(content, record.channel_message_counts);
  });
}

void append(ByteBuilder& out, const SummaryOffset& record) {
  append_record(out, Opcode::kSummaryOffset, [&](ByteBuilder& content) {
    content.number(static_cast<std::uint8_t>(record.group));
    content.number(record.group_start);
    content.number(record.group_size);
  });
}

void append_data_end(ByteBuilder& out, std::uint32_t data_crc) {
  append_record(out, Opcode::kDataEnd, [&](ByteBuilder& content) { content.number(data_crc); });
}

}  // namespace mstsl::io::mcap
