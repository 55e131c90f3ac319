#include "io/mcap/writer.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "io/compression.hpp"

namespace mstsl::io::mcap {
namespace {

/// Large enough that zstd finds what repeats, small enough that a reader seeks well; rosbag2's default is
/// near it.
constexpr std::size_t kChunkSize = 1 << 20;

/// Appends all records of one kind and notes where they lie.
template <typename Records>
void append_group(ByteBuilder& out, std::vector<SummaryOffset>& offsets, Opcode opcode, std::uint64_t base,
                  const Records& records) {
  const std::uint64_t start = base + out.bytes().size();
  for (const auto& record : records) append(out, record);
  const std::uint64_t size = base + out.bytes().size() - start;
  if (size > 0) offsets.push_back({opcode, start, size});
}

}  // namespace

Result<Writer> Writer::open(const std::filesystem::path& path, const std::string& profile,
                            const std::string& library) {
  Result<AtomicFile> file = AtomicFile::open(path);
  if (!file) return file.error();
  Writer writer(std::move(file).value());
  ByteBuilder out;
  out.append(as_bytes(kMagic));
  append(out, Header{profile, library});
  if (const Result<void> done = writer.emit(out.bytes()); !done) return done.error();
  return writer;
}

std::uint16_t Writer::add_schema(std::string name, std::string encoding, std::string data) {
  assert(statistics_.message_count == 0);
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back({id, std::move(name), std::move(encoding), std::move(data)});
  append(chunk_, schemas_.back());
  return id;
}

std::uint16_t Writer::add_channel(std::uint16_t schema_id, std::string topic, std::string message_encoding,
                                  std::map<std::string, std::string> metadata) {
  assert(statistics_.message_count == 0);
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_.push_back({id, schema_id, std::move(topic), std::move(message_encoding), std::move(metadata)});
  append(chunk_, channels_.back());
  return id;
}

Result<void> Writer::write(std::uint16_t channel_id, std::uint64_t log_time_ns, ByteView data) {
  assert(channel_id >= 1 && channel_id <= channels_.size());
  const std::uint64_t count = ++statistics_.channel_message_counts[channel_id];
  const bool first_in_chunk = chunk_messages_.empty();
  MessageIndex& index = chunk_messages_[channel_id];
  index.channel_id = channel_id;
  index.entries.emplace_back(log_time_ns, chunk_.bytes().size());
  append(chunk_, Message{channel_id, static_cast<std::uint32_t>(count), log_time_ns, log_time_ns, data});
  chunk_start_time_ = first_in_chunk ? log_time_ns : std::min(chunk_start_time_, log_time_ns);
  chunk_end_time_ = first_in_chunk ? log_time_ns : std::max(chunk_end_time_, log_time_ns);
  const bool first = statistics_.message_count++ == 0;
  statistics_.start_time = first ? log_time_ns : std::min(statistics_.start_time, log_time_ns);
  statistics_.end_time = first ? log_time_ns : std::max(statistics_.end_time, log_time_ns);
  return chunk_.bytes().size() < kChunkSize ? Result<void>() : flush_chunk();
}

Result<void> Writer::flush_chunk() {
  if (chunk_.bytes().empty()) return {};
  const Bytes compressed = compress_zstd(chunk_.bytes());
  if (compressed.empty()) return Error(file_.target().string() + ": no memory is left to compress a chunk");
  ChunkIndex index{.start_time = chunk_start_time_,
                   .end_time = chunk_end_time_,
                   .chunk_offset = offset_,
                   .compression = "zstd",
                   .compressed_size = compressed.size(),
                   .uncompressed_size = chunk_.bytes().size()};
  ByteBuilder out;
  append(out, Chunk{chunk_start_time_, chunk_end_time_, chunk_.bytes().size(), crc32(chunk_.bytes()), "zstd",
                    compressed.size(), compressed});
  index.chunk_size = out.bytes().size();
  for (const auto& [channel_id, messages] : chunk_messages_) {
    index.message_index_offsets[channel_id] = offset_ + out.bytes().size();
    append(out, messages);
  }
  index.message_index_size = out.bytes().size() - index.chunk_size;
  chunk_indexes_.push_back(std::move(index));
  chunk_.clear();
  chunk_messages_.clear();
  chunk_start_time_ = chunk_end_time_ = 0;
  return emit(out.bytes());
}

Result<void> Writer::close() {
  if (const Result<void> flushed = flush_chunk(); !flushed) return flushed;
  statistics_.schema_count = static_cast<std::uint16_t>(schemas_.size());
  statistics_.channel_count = static_cast<std::uint32_t>(channels_.size());
  statistics_.chunk_count = static_cast<std::uint32_t>(chunk_indexes_.size());
  ByteBuilder data_end;
  append_data_end(data_end, crc_);
  if (const Result<void> done = emit(data_end.bytes()); !done) return done;

  ByteBuilder summary;
  std::vector<SummaryOffset> offsets;
  const std::uint64_t start = offset_;
  append_group(summary, offsets, Opcode::kSchema, start, schemas_);
  append_group(summary, offsets, Opcode::kChannel, start, channels_);
  append_group(summary, offsets, Opcode::kStatistics, start, std::vector{statistics_});
  append_group(summary, offsets, Opcode::kChunkIndex, start, chunk_indexes_);
  Footer footer{start, start + summary.bytes().size(), 0};
  for (const SummaryOffset& offset : offsets) append(summary, offset);
  append(summary, footer);
  // The summary's CRC covers the footer up to the CRC itself, so the footer is written again with it.
  const ByteView before_crc =
      ByteView(summary.bytes()).first(summary.bytes().size() - sizeof(footer.summary_crc));
  footer.summary_crc = crc32(before_crc);
  ByteBuilder tail;
  tail.append(before_crc);
  tail.number(footer.summary_crc);
  tail.append(as_bytes(kMagic));
  if (const Result<void> done = emit(tail.bytes()); !done) return done;
  return file_.close();
}

Result<void> Writer::emit(ByteView bytes) {
  crc_ = crc32(bytes, crc_);
  offset_ += bytes.size();
  return file_.write(as_text(bytes));
}

}  // namespace mstsl::io::mcap
