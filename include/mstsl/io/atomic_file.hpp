#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

#include "mstsl/core/result.hpp"

namespace mstsl::io {

/// What becomes of a file that was begun but never closed.
enum class IfDropped {
  kRemove,   ///< nothing is left behind
  kKeepPart  ///< what was written so far stays under the temporary name
};

/// A file that appears under its final name whole or not at all: written as `NAME.part` in the same folder,
/// and on close() flushed to the disk and renamed. Two writers of one name exclude each other. A target that
/// exists and is no regular file (/dev/stdout, a pipe) is written to directly; a symbolic link stays one.
class AtomicFile {
 public:
  static Result<AtomicFile> open(const std::filesystem::path& target,
                                 IfDropped if_dropped = IfDropped::kRemove);
  AtomicFile(AtomicFile&&) noexcept;
  AtomicFile& operator=(AtomicFile&&) noexcept;
  ~AtomicFile();

  /// Adds bytes at the end, through a buffer. Errors: a full disk. After an error the file cannot be closed
  /// well.
  Result<void> write(std::string_view bytes);
  /// Hands the buffer to the operating system, so that the bytes survive this program's end (not a power
  /// cut).
  Result<void> flush();
  /// Makes the file appear under its final name. Nothing may be written afterwards.
  Result<void> close();

  const std::filesystem::path& target() const;

 private:
  struct State;
  explicit AtomicFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes a whole file at once, atomically.
Result<void> write_file(const std::filesystem::path& target, std::string_view bytes);

/// The name that AtomicFile writes `target` under until it is closed.
std::filesystem::path part_name(const std::filesystem::path& target);

}  // namespace mstsl::io
