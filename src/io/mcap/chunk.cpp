#include "io/mcap/chunk.hpp"

#include <cstdint>

namespace mstsl::io::mcap {
namespace {

/// No writer makes chunks near this size (they hold a whole chunk in memory, too).
constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 30;

}  // namespace

UnpackedChunk unpack(const Chunk& chunk, Decompressor& decompressor) {
  if (!Decompressor::knows(chunk.compression)) return {{}, "chunks with an unknown compression skipped"};
  if (chunk.uncompressed_size > kLargestChunk) return {{}, "chunks of an impossible size skipped"};
  const Decompressor::Output out =
      decompressor.decompress(chunk.compression, chunk.records, chunk.uncompressed_size);
  if (!out.whole) return {out.bytes, "chunks cut short"};
  if (chunk.uncompressed_crc != 0 && crc32(out.bytes) != chunk.uncompressed_crc)
    return {{}, "chunks with a wrong check sum skipped"};
  return {out.bytes, {}};
}

}  // namespace mstsl::io::mcap
