#pragma once

#include <cstdint>
#include <optional>

#include "io/bytes.hpp"
#include "io/input_file.hpp"
#include "io/mcap/records.hpp"

namespace mstsl::io::mcap {

/// A record whose content nobody has checked.
struct Record {
  Opcode opcode{};
  std::uint64_t offset = 0;        ///< of its opcode in the file
  std::uint64_t content_size = 0;  ///< as promised
  ByteView content;                ///< shorter than promised where the file ends in the middle
};

/// Goes through the records of a file's data section, reading only as far as it is asked to.
class RecordStream {
 public:
  /// `sum_up`: keep the CRC of all bytes passed, which means to read them all.
  RecordStream(const InputFile& file, std::uint64_t offset, bool sum_up);

  /// Opcode and size of the next record, its content not yet read; nothing where the file ends.
  std::optional<Record> next();
  /// Reads the content of the record that next() just gave, or as much of it as is there. A record larger
  /// than any writer makes keeps an empty content.
  void load(Record& record);
  void seek(std::uint64_t offset);

  /// Of all bytes before the current record, while every one of them was seen.
  std::optional<std::uint32_t> crc_before() const { return crc_before_; }

 private:
  void pass(std::uint64_t size);

  SequentialReader reader_;
  std::optional<std::uint32_t> crc_, crc_before_;
  std::uint64_t next_offset_ = 0;
};

/// Calls `visit(opcode, content)` for the whole records in `bytes`; false where they end in the middle of
/// one.
template <typename Visit>
bool for_each_record(ByteView bytes, Visit visit) {
  ByteCursor in(bytes);
  while (in.remaining() > 0) {
    const auto opcode = static_cast<Opcode>(in.number<std::uint8_t>());
    const ByteView content = in.sized<std::uint64_t>();
    if (!in.ok()) return false;
    visit(opcode, content);
  }
  return true;
}

}  // namespace mstsl::io::mcap
