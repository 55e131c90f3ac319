#include "io/bag/record_stream.hpp"

#include <algorithm>
#include <utility>

namespace mstsl::io::bag {
namespace {

/// The largest header that is written holds a topic's name and a few numbers.
constexpr std::uint32_t kLargestHeader = 1 << 20;

}  // namespace

std::optional<Record> RecordStream::next() {
  reader_.seek(next_offset_);
  const std::uint64_t offset = next_offset_;
  const auto take_size = [this]() -> std::optional<std::uint32_t> {
    const std::optional<ByteView> bytes = reader_.take(sizeof(std::uint32_t));
    if (!bytes) return std::nullopt;
    return ByteCursor(*bytes).number<std::uint32_t>();
  };
  const std::optional<std::uint32_t> header_size = take_size();
  if (!header_size || *header_size > kLargestHeader) return std::nullopt;
  const std::optional<ByteView> header = reader_.take(*header_size);
  if (!header) return std::nullopt;
  header_.assign(header->begin(), header->end());
  std::optional<Fields> fields = Fields::parse(header_);
  const std::optional<std::uint32_t> data_size = take_size();
  if (!fields || !data_size) return std::nullopt;
  data_offset_ = reader_.offset();
  next_offset_ = data_offset_ + std::min<std::uint64_t>(*data_size, reader_.remaining());
  return Record{offset, std::move(*fields), *data_size};
}

ByteView RecordStream::load(const Record& record) {
  const std::uint64_t size = std::min<std::uint64_t>(record.data_size, reader_.remaining());
  return reader_.take(size).value_or(ByteView{});
}

}  // namespace mstsl::io::bag
