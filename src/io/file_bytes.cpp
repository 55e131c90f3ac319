#include "mstsl/io/file_bytes.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include <fmt/format.h>

namespace mstsl::io {
namespace {

constexpr std::size_t kPieceBytes = 1 << 16;

Error cannot_read(const std::filesystem::path& file, const std::string& reason) {
  return Error(fmt::format("cannot read {}: {}", file.string(), reason));
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& file, std::size_t limit_bytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    return cannot_read(file, "it is a folder; give the name of a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) return cannot_read(file, std::generic_category().message(errno));
  std::string bytes;
  // Piece by piece rather than by the size the file system tells: pipes and /proc have none.
  for (std::size_t got = kPieceBytes; got == kPieceBytes;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kPieceBytes);
    got = std::fread(bytes.data() + before, 1, kPieceBytes, stream.get());
    bytes.resize(before + got);
    if (bytes.size() > limit_bytes)
      return cannot_read(
          file, fmt::format("it is larger than {} MiB, the most that is sensible here", limit_bytes >> 20));
  }
  if (std::ferror(stream.get()) != 0) return cannot_read(file, "the disk reports an error");
  return bytes;
}

}  // namespace mstsl::io
