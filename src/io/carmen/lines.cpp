#include "io/carmen/lines.hpp"

#include <utility>

#include <fmt/format.h>

namespace mstsl::io::carmen {
namespace {

constexpr unsigned kBlockSize = 1 << 18;
/// A scan of a thousand beams takes 10 kB.
constexpr std::size_t kLongestLine = 1 << 20;

}  // namespace

Result<Lines> Lines::open(const std::filesystem::path& path) {
  const gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) return Error(fmt::format("{}: cannot be opened", path.string()));
  gzbuffer(file, kBlockSize);
  return Lines(file);
}

std::optional<std::string> Lines::next() {
  for (;;) {
    const std::size_t end = buffer_.find('\n', place_);
    if (end != std::string::npos || buffer_.size() - place_ > kLongestLine) {
      std::string line = buffer_.substr(place_, end == std::string::npos ? end : end - place_);
      place_ = end == std::string::npos ? buffer_.size() : end + 1;
      if (line.ends_with('\r')) line.pop_back();
      return line;
    }
    buffer_.erase(0, std::exchange(place_, 0));
    const std::size_t kept = buffer_.size();
    buffer_.resize(kept + kBlockSize);
    const int count = gzread(file_.get(), buffer_.data() + kept, kBlockSize);
    buffer_.resize(kept + static_cast<std::size_t>(count > 0 ? count : 0));
    if (count > 0) continue;
    int code = Z_OK;
    gzerror(file_.get(), &code);
    damaged_ = code != Z_OK && code != Z_STREAM_END;
    // What is left has no end of line: whole in a finished file, cut off in a damaged one.
    if (buffer_.empty() || damaged_) return std::nullopt;
    return std::exchange(buffer_, {});
  }
}

}  // namespace mstsl::io::carmen
