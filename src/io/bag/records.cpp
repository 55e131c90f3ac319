#include "io/bag/records.hpp"

#include <utility>

namespace mstsl::io::bag {
namespace {

std::optional<Stamp> time_of(const Fields& fields, std::string_view name) {
  const std::string_view bytes = fields.text(name);
  if (bytes.size() != 8) return std::nullopt;
  ByteCursor in(as_bytes(bytes));
  const auto seconds = in.number<std::uint32_t>();
  return Stamp::from_parts(seconds, in.number<std::uint32_t>());
}

}  // namespace

std::optional<Fields> Fields::parse(ByteView bytes) {
  ByteCursor in(bytes);
  while (in.remaining() > 0) {
    const std::size_t equals = in.text().find('=');
    if (equals == 0 || equals == std::string_view::npos) return std::nullopt;
  }
  if (!in.ok()) return std::nullopt;
  return Fields(bytes);
}

std::string_view Fields::text(std::string_view name) const {
  ByteCursor in(bytes_);
  while (in.remaining() > 0) {
    const std::string_view field = in.text();
    if (field.size() > name.size() && field[name.size()] == '=' && field.starts_with(name))
      return field.substr(name.size() + 1);
  }
  return {};
}

std::optional<std::uint64_t> parse_index_position(const Fields& fields) {
  if (fields.op() != Op::kBagHeader) return std::nullopt;
  return fields.number<std::uint64_t>("index_pos");
}

std::optional<Connection> parse_connection(const Fields& fields, ByteView data) {
  const auto id = fields.number<std::uint32_t>("conn");
  const std::optional<Fields> details = Fields::parse(data);
  if (!id || !details) return std::nullopt;
  // The topic outside is the one under which it was recorded; the one inside may be from before a remapping.
  return Connection{*id, std::string(fields.text("topic")), std::string(details->text("type"))};
}

std::optional<Message> parse_message(const Fields& fields, ByteView data) {
  const auto connection = fields.number<std::uint32_t>("conn");
  const std::optional<Stamp> time = time_of(fields, "time");
  if (!connection || !time) return std::nullopt;
  return Message{*connection, *time, data};
}

std::optional<Chunk> parse_chunk(const Fields& fields) {
  const auto size = fields.number<std::uint32_t>("size");
  if (!size) return std::nullopt;
  return Chunk{fields.text("compression"), *size};
}

std::optional<ChunkInfo> parse_chunk_info(const Fields& fields, ByteView data) {
  const auto position = fields.number<std::uint64_t>("chunk_pos");
  const std::optional<Stamp> first = time_of(fields, "start_time");
  const std::optional<Stamp> last = time_of(fields, "end_time");
  if (!position || !first || !last) return std::nullopt;
  ChunkInfo info{*position, *first, *last, {}};
  ByteCursor in(data);
  while (in.remaining() > 0) {
    const auto connection = in.number<std::uint32_t>();
    info.message_counts[connection] = in.number<std::uint32_t>();
  }
  if (!in.ok()) return std::nullopt;
  return info;
}

}  // namespace mstsl::io::bag
