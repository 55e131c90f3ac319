#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "mstsl/core/result.hpp"

#include "io/bytes.hpp"

namespace mstsl::io {

/// A file (or bytes in memory, for tests) that is read at any place.
class InputFile {
 public:
  static Result<InputFile> open(const std::filesystem::path& path);
  /// Reads `contents`, which must outlive it.
  static InputFile in_memory(ByteView contents, std::string name = "memory");

  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&& other) noexcept;
  ~InputFile();

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }

  /// Fills `buffer` from `offset`; false when the file ends before, or cannot be read there.
  bool read_at(std::uint64_t offset, std::span<std::byte> buffer) const;

 private:
  InputFile() = default;
  std::string name_;
  std::uint64_t size_ = 0;
  int descriptor_ = -1;
  ByteView memory_;
};

/// Reads a file from some offset on, a large block at a time.
class SequentialReader {
 public:
  explicit SequentialReader(const InputFile& file, std::uint64_t offset = 0)
      : file_(&file), offset_(offset) {}

  std::uint64_t offset() const { return offset_; }
  std::uint64_t remaining() const { return file_->size() > offset_ ? file_->size() - offset_ : 0; }
  void seek(std::uint64_t offset) { offset_ = offset; }

  /// The next bytes, valid until the next call; empty when fewer than `size` are left.
  /// Never allocates more than the file holds.
  std::optional<ByteView> take(std::uint64_t size);

 private:
  const InputFile* file_;
  std::uint64_t offset_;
  Bytes buffer_;
  std::uint64_t buffer_offset_ = 0;
  std::size_t buffer_size_ = 0;
};

}  // namespace mstsl::io
