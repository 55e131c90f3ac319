#pragma once

#include <cstdint>
#include <optional>

#include "io/bag/records.hpp"
#include "io/bytes.hpp"
#include "io/input_file.hpp"

namespace mstsl::io::bag {

/// A record's header; its data are not yet read.
struct Record {
  std::uint64_t offset = 0;
  Fields fields;
  std::uint32_t data_size = 0;  ///< as promised
};

/// Goes through the records of a bag, reading data only where asked.
class RecordStream {
 public:
  RecordStream(const InputFile& file, std::uint64_t offset) : reader_(file, offset), next_offset_(offset) {}

  /// Nothing where the file ends, or holds no record. The fields are valid until the next call.
  std::optional<Record> next();
  /// The data of the record that next() just gave, shorter than promised where the file ends in the middle.
  /// Valid until the next call.
  ByteView load(const Record& record);
  void seek(std::uint64_t offset) { next_offset_ = offset; }
  std::uint64_t next_offset() const { return next_offset_; }
  /// Whether all of the data of the record that next() just gave are in the file.
  bool is_whole(const Record& record) const { return next_offset_ - data_offset_ == record.data_size; }

 private:
  SequentialReader reader_;
  Bytes header_;
  std::uint64_t next_offset_;
  std::uint64_t data_offset_ = 0;
};

}  // namespace mstsl::io::bag
