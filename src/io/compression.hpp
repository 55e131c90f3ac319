#pragma once

#include <cstdint>
#include <string_view>

#include "io/bytes.hpp"

namespace mstsl::io {

/// Takes one compressed piece apart. Keeps its output buffer, so one object serves a whole file.
class Decompressor {
 public:
  /// The scheme's name as MCAP ("", "lz4", "zstd") and ROS 1 bags ("none", "lz4", "bz2") write it.
  static bool knows(std::string_view scheme);

  struct Output {
    ByteView bytes;      ///< what came out, also before a damage; valid until the next call
    bool whole = false;  ///< exactly the promised size came out
  };
  /// The buffer grows with what really comes out, never with what a hostile header promises, and stops at
  /// `promised_size`.
  Output decompress(std::string_view scheme, ByteView compressed, std::uint64_t promised_size);

 private:
  Bytes buffer_;
};

/// Empty when zstd fails, which it does only without memory.
Bytes compress_zstd(ByteView bytes);

/// The CRC-32 that MCAP uses (zlib's); `crc` is that of the bytes before.
std::uint32_t crc32(ByteView bytes, std::uint32_t crc = 0);

}  // namespace mstsl::io
