#include "io/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace mstsl::io {
namespace {

constexpr std::size_t kBlockSize = 1 << 20;

}  // namespace

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  InputFile file;
  file.name_ = path.string();
  // Not to wait for the writer of a pipe: a log is read from both ends.
  file.descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file.descriptor_ < 0)
    return Error(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  struct stat status {};
  if (::fstat(file.descriptor_, &status) != 0 || !S_ISREG(status.st_mode))
    return Error(fmt::format("{}: is not a regular file", path.string()));
  file.size_ = static_cast<std::uint64_t>(status.st_size);
  return file;
}

InputFile InputFile::in_memory(ByteView contents, std::string name) {
  InputFile file;
  file.name_ = std::move(name);
  file.size_ = contents.size();
  file.memory_ = contents;
  return file;
}

InputFile::InputFile(InputFile&& other) noexcept { *this = std::move(other); }

InputFile& InputFile::operator=(InputFile&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(size_, other.size_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(memory_, other.memory_);
  return *this;
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool InputFile::read_at(std::uint64_t offset, std::span<std::byte> buffer) const {
  if (offset > size_ || buffer.size() > size_ - offset) return false;
  if (descriptor_ < 0) {
    std::ranges::copy(memory_.subspan(static_cast<std::size_t>(offset), buffer.size()), buffer.begin());
    return true;
  }
  std::size_t done = 0;
  while (done < buffer.size()) {
    const ssize_t count =
        ::pread(descriptor_, buffer.data() + done, buffer.size() - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

std::optional<ByteView> SequentialReader::take(std::uint64_t size) {
  if (size > remaining()) return std::nullopt;
  const bool buffered = offset_ >= buffer_offset_ && offset_ + size <= buffer_offset_ + buffer_size_;
  if (!buffered) {
    buffer_size_ = static_cast<std::size_t>(
        std::min<std::uint64_t>(std::max<std::uint64_t>(size, kBlockSize), remaining()));
    if (buffer_.size() < buffer_size_) buffer_.resize(buffer_size_);
    buffer_offset_ = offset_;
    if (!file_->read_at(offset_, std::span(buffer_).first(buffer_size_))) {
      buffer_size_ = 0;
      return std::nullopt;
    }
  }
  const auto start = static_cast<std::size_t>(offset_ - buffer_offset_);
  offset_ += size;
  return ByteView(buffer_).subspan(start, static_cast<std::size_t>(size));
}

}  // namespace mstsl::io
