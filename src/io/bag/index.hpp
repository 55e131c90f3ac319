#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "io/bag/records.hpp"
#include "io/compression.hpp"
#include "io/input_file.hpp"

namespace mstsl::io::bag {

/// What a bag holds.
struct Index {
  std::map<std::uint32_t, Connection> connections;
  std::map<std::uint64_t, ChunkInfo> chunks;  ///< by position in the file; empty where the bag has no index
  std::map<std::uint32_t, std::uint64_t> message_counts;
  std::optional<Stamp> first, last;
};

/// From the index at the end of the bag; nothing when it was never written or is damaged.
std::optional<Index> read_index(const InputFile& file);

/// By a pass over the whole bag.
Index scan_index(const InputFile& file);

/// The records in a chunk, as many as can be unpacked; empty when its header makes no sense.
Decompressor::Output unpack(const Fields& fields, ByteView data, Decompressor& decompressor);

}  // namespace mstsl::io::bag
