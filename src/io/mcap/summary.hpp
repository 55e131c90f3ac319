#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "io/input_file.hpp"
#include "io/mcap/records.hpp"

namespace mstsl::io::mcap {

/// What a file says about itself.
struct Summary {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::map<std::uint64_t, ChunkIndex> chunks;  ///< by offset in the file
  std::optional<Statistics> statistics;
  std::uint32_t data_crc = 0;  ///< of all bytes before the record DataEnd, 0: not given
};

/// From the end of the file; nothing when there is no summary, or it is damaged or leaves out the channels.
std::optional<Summary> read_summary(const InputFile& file);

/// By a pass over the whole file.
Summary scan_summary(const InputFile& file);

}  // namespace mstsl::io::mcap
