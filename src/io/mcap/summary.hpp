#pragma once

#include <cstdint>
#include <map>

#include "io/input_file.hpp"
#include "io/mcap/records.hpp"

namespace mstsl::io::mcap {

/// What a file says about itself.
struct Summary {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::map<std::uint64_t, ChunkIndex> chunks;  ///< by offset in the file
  Statistics statistics;
  std::uint32_t data_crc = 0;  ///< of all bytes before the record DataEnd, 0: not given
  bool is_damaged = false;     ///< the file has one, but its check sum is wrong or it ends in the middle
};

/// Reads the summary at the end of the file or, where that cannot be, makes one by a pass over the whole
/// file.
Summary summarize(const InputFile& file);

}  // namespace mstsl::io::mcap
