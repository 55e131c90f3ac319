#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <zlib.h>

#include "mstsl/core/result.hpp"

namespace mstsl::io::carmen {

/// The lines of a text file, packed by gzip or not.
class Lines {
 public:
  static Result<Lines> open(const std::filesystem::path& path);

  /// The next line without its end; nothing at the end of the file or where it is damaged. One that is longer
  /// than any log's is given in pieces.
  std::optional<std::string> next();
  /// Whether the file ended before its compressed data did.
  bool is_damaged() const { return damaged_; }

 private:
  struct Close {
    void operator()(gzFile file) const { gzclose(file); }
  };
  explicit Lines(gzFile file) : file_(file) {}

  std::unique_ptr<gzFile_s, Close> file_;
  std::string buffer_;
  std::size_t place_ = 0;
  bool damaged_ = false;
};

}  // namespace mstsl::io::carmen
