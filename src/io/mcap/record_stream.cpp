#include "io/mcap/record_stream.hpp"

#include <algorithm>

#include "io/compression.hpp"

namespace mstsl::io::mcap {
namespace {

/// A chunk is held in memory as a whole by those who write and read it; none comes near this.
constexpr std::uint64_t kLargestRecord = std::uint64_t{1} << 30;

}  // namespace

RecordStream::RecordStream(const InputFile& file, std::uint64_t offset, bool sum_up)
    : reader_(file), next_offset_(offset) {
  if (!sum_up) return;
  crc_ = 0;
  pass(offset);
}

std::optional<Record> RecordStream::next() {
  if (next_offset_ > reader_.offset()) pass(next_offset_ - reader_.offset());
  crc_before_ = crc_;
  const std::uint64_t offset = reader_.offset();
  const std::optional<ByteView> head = reader_.take(kRecordHeadSize);
  if (!head) return std::nullopt;
  if (crc_) crc_ = crc32(*head, *crc_);
  ByteCursor in(*head);
  Record record;
  record.offset = offset;
  record.opcode = static_cast<Opcode>(in.number<std::uint8_t>());
  record.content_size = in.number<std::uint64_t>();
  next_offset_ = reader_.offset() + std::min(record.content_size, reader_.remaining());
  return record;
}

void RecordStream::load(Record& record) {
  if (record.content_size > kLargestRecord && reader_.remaining() > kLargestRecord) return;
  const std::optional<ByteView> content = reader_.take(std::min(record.content_size, reader_.remaining()));
  record.content = content.value_or(ByteView{});
  if (crc_) crc_ = crc32(record.content, *crc_);
}

void RecordStream::seek(std::uint64_t offset) {
  crc_.reset();
  reader_.seek(offset);
  next_offset_ = offset;
}

void RecordStream::pass(std::uint64_t size) {
  if (!crc_) return reader_.seek(reader_.offset() + size);
  constexpr std::uint64_t kPiece = 1 << 20;
  while (size > 0) {
    const std::optional<ByteView> piece = reader_.take(std::min(size, kPiece));
    if (!piece) return seek(reader_.offset() + size);
    crc_ = crc32(*piece, *crc_);
    size -= piece->size();
  }
}

}  // namespace mstsl::io::mcap
