#include "io/mcap/summary.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "io/compression.hpp"
#include "io/mcap/chunk.hpp"
#include "io/mcap/record_stream.hpp"

namespace mstsl::io::mcap {
namespace {

/// A summary holds an index entry of about 100 bytes for each chunk; even terabytes stay below this.
constexpr std::uint64_t kLargestSummary = std::uint64_t{1} << 30;

struct FooterPlace {
  Footer footer;
  std::uint64_t offset;
};

std::optional<FooterPlace> find_footer(const InputFile& file) {
  const std::uint64_t end_size = kFooterSize + kMagic.size();
  if (file.size() < kMagic.size() + end_size) return std::nullopt;
  const std::uint64_t offset = file.size() - end_size;
  Bytes bytes(end_size);
  if (!file.read_at(offset, bytes)) return std::nullopt;
  ByteCursor in(bytes);
  const auto opcode = static_cast<Opcode>(in.number<std::uint8_t>());
  const std::optional<Footer> footer = parse_footer(in.sized<std::uint64_t>());
  if (opcode != Opcode::kFooter || !footer || as_text(in.take(in.remaining())) != kMagic) return std::nullopt;
  return FooterPlace{*footer, offset};
}

std::uint32_t read_data_crc(const InputFile& file, std::uint64_t data_end) {
  Bytes bytes(kDataEndSize);
  if (data_end < kMagic.size() + bytes.size() || !file.read_at(data_end - bytes.size(), bytes)) return 0;
  ByteCursor in(bytes);
  const auto opcode = static_cast<Opcode>(in.number<std::uint8_t>());
  const bool right_size = in.number<std::uint64_t>() == sizeof(std::uint32_t);
  return opcode == Opcode::kDataEnd && right_size ? in.number<std::uint32_t>() : 0;
}

/// What a summary section says, and whether it counts its channels: without that no one knows if all are
/// named.
struct Collected {
  Summary summary;
  bool has_statistics = false;
};

void collect(Collected& all, Opcode opcode, ByteView content) {
  Summary& summary = all.summary;
  if (opcode == Opcode::kSchema) {
    if (auto schema = parse_schema(content)) summary.schemas.try_emplace(schema->id, std::move(*schema));
  } else if (opcode == Opcode::kChannel) {
    if (auto channel = parse_channel(content)) summary.channels.try_emplace(channel->id, std::move(*channel));
  } else if (opcode == Opcode::kChunkIndex) {
    if (auto index = parse_chunk_index(content))
      summary.chunks.try_emplace(index->chunk_offset, std::move(*index));
  } else if (opcode == Opcode::kStatistics) {
    if (auto statistics = parse_statistics(content)) {
      summary.statistics = std::move(*statistics);
      all.has_statistics = true;
    }
  }
}

enum class Found { kNone, kDamaged, kIncomplete, kWhole };

Found read_summary(const InputFile& file, const FooterPlace& place, Summary& summary) {
  const auto& [footer, footer_offset] = place;
  const std::uint64_t start = footer.summary_start;
  if (start == 0) return Found::kNone;
  if (start < kMagic.size() || start >= footer_offset || footer_offset - start > kLargestSummary)
    return Found::kDamaged;
  constexpr std::uint64_t kFooterBeforeCrc = kFooterSize - sizeof(footer.summary_crc);
  Bytes bytes(static_cast<std::size_t>(footer_offset + kFooterBeforeCrc - start));
  if (!file.read_at(start, bytes)) return Found::kDamaged;
  if (footer.summary_crc != 0 && crc32(bytes) != footer.summary_crc) return Found::kDamaged;

  Collected all;
  const ByteView records = ByteView(bytes).first(bytes.size() - kFooterBeforeCrc);
  if (!for_each_record(records, [&all](Opcode opcode, ByteView content) { collect(all, opcode, content); }))
    return Found::kDamaged;
  if (!all.has_statistics || all.summary.channels.size() != all.summary.statistics.channel_count)
    return Found::kIncomplete;
  summary = std::move(all.summary);
  return Found::kWhole;
}

void count(Statistics& statistics, const Message& message) {
  const bool first = statistics.message_count++ == 0;
  statistics.start_time = first ? message.log_time : std::min(statistics.start_time, message.log_time);
  statistics.end_time = first ? message.log_time : std::max(statistics.end_time, message.log_time);
  ++statistics.channel_message_counts[message.channel_id];
}

Summary scan(const InputFile& file) {
  Collected all;
  Statistics statistics;
  const auto take = [&](Opcode opcode, ByteView content) {
    if (opcode == Opcode::kSchema || opcode == Opcode::kChannel) collect(all, opcode, content);
    if (opcode != Opcode::kMessage) return;
    if (const std::optional<Message> message = parse_message(content)) count(statistics, *message);
  };
  Decompressor decompressor;
  RecordStream stream(file, kMagic.size(), false);
  while (std::optional<Record> record = stream.next()) {
    if (record->opcode == Opcode::kDataEnd || record->opcode == Opcode::kFooter) break;
    if (record->opcode > Opcode::kChunk) continue;
    stream.load(*record);
    if (record->opcode == Opcode::kChunk) {
      if (const std::optional<Chunk> chunk = parse_chunk(record->content))
        for_each_record(unpack(*chunk, decompressor).records, take);
    } else if (record->content.size() == record->content_size) {
      take(record->opcode, record->content);
    }
  }
  all.summary.statistics = std::move(statistics);
  return std::move(all.summary);
}

}  // namespace

Summary summarize(const InputFile& file) {
  const std::optional<FooterPlace> place = find_footer(file);
  Summary summary;
  const Found found = place ? read_summary(file, *place, summary) : Found::kNone;
  if (found != Found::kWhole) summary = scan(file);
  summary.is_damaged = found == Found::kDamaged;
  if (place && found != Found::kDamaged) {
    const std::uint64_t start = place->footer.summary_start;
    summary.data_crc = read_data_crc(file, start == 0 ? place->offset : start);
  }
  return summary;
}

}  // namespace mstsl::io::mcap
