#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/io/atomic_file.hpp"

#include "io/bytes.hpp"
#include "io/mcap/records.hpp"

namespace mstsl::io::mcap {

/// Writes an MCAP file: chunks packed with zstd, message and chunk indexes, statistics, summary offsets and
/// all CRCs. The file appears under its name when closed; one that is dropped unclosed leaves nothing.
class Writer {
 public:
  static Result<Writer> open(const std::filesystem::path& file, const std::string& profile,
                             const std::string& library);

  /// Schemas and channels are numbered from 1 by order of their adding, and have to be added before the first
  /// message.
  std::uint16_t add_schema(std::string name, std::string encoding, std::string data);
  std::uint16_t add_channel(std::uint16_t schema_id, std::string topic, std::string message_encoding,
                            std::map<std::string, std::string> metadata);

  Result<void> write(std::uint16_t channel_id, std::uint64_t log_time_ns, ByteView data);
  Result<void> close();

 private:
  explicit Writer(AtomicFile file) : file_(std::move(file)) {}
  Result<void> flush_chunk();
  Result<void> emit(ByteView bytes);

  AtomicFile file_;
  std::uint64_t offset_ = 0;
  std::uint32_t crc_ = 0;  ///< of all bytes written so far
  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
  ByteBuilder chunk_;
  std::map<std::uint16_t, MessageIndex> chunk_messages_;
  std::uint64_t chunk_start_time_ = 0, chunk_end_time_ = 0;
  std::vector<ChunkIndex> chunk_indexes_;
  Statistics statistics_;
};

}  // namespace mstsl::io::mcap
