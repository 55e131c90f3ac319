#include "mstsl/io/atomic_file.hpp"

#include <cassert>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace mstsl::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBufferBytes = 1 << 18;

std::string_view advice(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "; free some space or choose another place for it";
    case ENOENT:
      return "; make its folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; choose a folder that you may write to";
    default:
      return "";
  }
}

Error cannot_write(const fs::path& file, int code) {
  return Error(fmt::format("cannot write {}: {}{}", file.string(), std::generic_category().message(code),
                           advice(code)));
}

/// Whether the locked descriptor is still what the name stands for: another writer may have renamed it
/// meanwhile.
bool is_still_named(int descriptor, const fs::path& name) {
  struct stat by_descriptor {};
  struct stat by_name {};
  return fstat(descriptor, &by_descriptor) == 0 && lstat(name.c_str(), &by_name) == 0 &&
         by_descriptor.st_ino == by_name.st_ino && by_descriptor.st_dev == by_name.st_dev;
}

/// Opens and locks the temporary file, emptied; -1 and errno on failure (EWOULDBLOCK: someone else is writing
/// it).
int open_part(const fs::path& part) {
  for (;;) {
    const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0) return -1;
    // Some network file systems know no locks; only a lock that someone else holds is a reason to stop.
    const bool taken = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!taken && !is_still_named(descriptor, part)) {
      ::close(descriptor);
      continue;
    }
    if (!taken && ftruncate(descriptor, 0) == 0) return descriptor;
    const int code = taken ? EWOULDBLOCK : errno;
    ::close(descriptor);
    errno = code;
    return -1;
  }
}

void sync_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // the data are safe; only the name's durability is best effort
  fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

struct AtomicFile::State {
  fs::path target;
  fs::path final_name;  // target with symbolic links followed
  fs::path part;        // empty when the target is written directly
  IfDropped if_dropped = IfDropped::kRemove;
  int descriptor = -1;
  int failure = 0;  // errno of the first failed write
  std::string buffer;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (descriptor < 0) return;
    const bool keep = if_dropped == IfDropped::kKeepPart;
    if (keep) drain();
    ::close(descriptor);
    if (!keep && !part.empty()) unlink(part.c_str());
  }

  bool drain() {
    std::string_view rest = buffer;
    while (!rest.empty() && failure == 0) {
      const ssize_t written = ::write(descriptor, rest.data(), rest.size());
      if (written > 0)
        rest.remove_prefix(static_cast<std::size_t>(written));
      else if (written == 0 || errno != EINTR)
        failure = written == 0 ? EIO : errno;
    }
    buffer.clear();
    return failure == 0;
  }

  bool settle() {
    if (!drain()) return false;
    const bool synced = fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP || errno == EROFS;
    if (!synced) failure = errno;
    if (::close(std::exchange(descriptor, -1)) != 0 && failure == 0) failure = errno;
    if (failure == 0 && !part.empty() && rename(part.c_str(), final_name.c_str()) != 0) failure = errno;
    if (failure != 0 && !part.empty() && if_dropped == IfDropped::kRemove) unlink(part.c_str());
    return failure == 0;
  }
};

AtomicFile::AtomicFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
AtomicFile::AtomicFile(AtomicFile&&) noexcept = default;
AtomicFile& AtomicFile::operator=(AtomicFile&&) noexcept = default;
AtomicFile::~AtomicFile() = default;

const fs::path& AtomicFile::target() const { return state_->target; }

Result<AtomicFile> AtomicFile::open(const fs::path& target, IfDropped if_dropped) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (target.empty() || !target.has_filename() || fs::is_directory(status))
    return Error(fmt::format("cannot write '{}': it is a folder; give the name of a file", target.string()));
  auto state = std::make_unique<State>();
  state->target = state->final_name = target;
  state->if_dropped = if_dropped;
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    state->descriptor = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
    if (state->descriptor < 0) return cannot_write(target, errno);
    return AtomicFile(std::move(state));
  }
  if (fs::is_symlink(target, ignored)) state->final_name = fs::weakly_canonical(target, ignored);
  const fs::path part = part_name(state->final_name);
  state->descriptor = open_part(part);
  if (state->descriptor < 0 && errno == EWOULDBLOCK)
    return Error(fmt::format(
        "cannot write {}: another program is writing it just now; wait for it or choose another name",
        target.string()));
  if (state->descriptor < 0) return cannot_write(target, errno);
  state->part = part;
  struct stat existing {};
  if (stat(state->final_name.c_str(), &existing) == 0 &&
      fchmod(state->descriptor, existing.st_mode & 07777) != 0)
    return cannot_write(target, errno);
  return AtomicFile(std::move(state));
}

Result<void> AtomicFile::write(std::string_view bytes) {
  assert(state_ && state_->descriptor >= 0);
  state_->buffer.append(bytes);
  return state_->buffer.size() < kBufferBytes ? Result<void>() : flush();
}

Result<void> AtomicFile::flush() {
  assert(state_ && state_->descriptor >= 0);
  if (!state_->drain()) return cannot_write(state_->target, state_->failure);
  return {};
}

Result<void> AtomicFile::close() {
  assert(state_ && state_->descriptor >= 0);
  if (state_->settle()) {
    if (!state_->part.empty()) sync_folder(state_->final_name);
    return {};
  }
  return cannot_write(state_->target, state_->failure);
}

Result<void> write_file(const fs::path& target, std::string_view bytes) {
  Result<AtomicFile> file = AtomicFile::open(target);
  if (!file) return file.error();
  if (const Result<void> written = file->write(bytes); !written) return written;
  return file->close();
}

fs::path part_name(const fs::path& target) {
  fs::path name = target;
  name += ".part";
  return name;
}

}  // namespace mstsl::io
