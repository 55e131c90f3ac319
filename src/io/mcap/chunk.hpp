#pragma once

#include <string>

#include "io/compression.hpp"
#include "io/mcap/records.hpp"

namespace mstsl::io::mcap {

/// The records that a chunk holds.
struct UnpackedChunk {
  ByteView records;     ///< as many as could be unpacked; valid until the next chunk
  std::string problem;  ///< what is wrong with them, in the words of a report; empty: nothing
};

/// A chunk whose CRC is wrong gives no records; one that ends in the middle gives those before.
UnpackedChunk unpack(const Chunk& chunk, Decompressor& decompressor);

}  // namespace mstsl::io::mcap
