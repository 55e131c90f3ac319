#include "mstsl/io/atomic_file.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "mstsl/io/file_bytes.hpp"

#include "test_support.hpp"

namespace mstsl::io {
namespace {

namespace fs = std::filesystem;
using test::must;

std::string content(const fs::path& file) { return must(read_file(file, 1 << 20)); }

TEST(AtomicFile, AppearsWholeAndOnlyWhenClosed) {
  const test::TemporaryFolder folder;
  const fs::path name = folder.path() / "out.txt";
  AtomicFile file = must(AtomicFile::open(name));
  must(file.write("one "));
  must(file.write("two"));
  EXPECT_FALSE(fs::exists(name));
  must(file.close());
  EXPECT_EQ(content(name), "one two");
  EXPECT_FALSE(fs::exists(part_name(name)));
}

TEST(AtomicFile, LeavesTheOldFileAloneWhenDropped) {
  const test::TemporaryFolder folder;
  const fs::path name = folder.path() / "out.txt";
  must(write_file(name, "old"));
  {
    AtomicFile file = must(AtomicFile::open(name));
    must(file.write("new"));
    must(file.flush());
  }
  EXPECT_EQ(content(name), "old");
  EXPECT_FALSE(fs::exists(part_name(name)));
}

TEST(AtomicFile, KeepsThePartOfAnInterruptedRunWhenAsked) {
  const test::TemporaryFolder folder;
  const fs::path name = folder.path() / "out.txt";
  {
    AtomicFile file = must(AtomicFile::open(name, IfDropped::kKeepPart));
    must(file.write("so far"));
  }
  EXPECT_FALSE(fs::exists(name));
  EXPECT_EQ(content(part_name(name)), "so far");
  must(write_file(name, "next run"));  // a leftover does not stand in the way
  EXPECT_EQ(content(name), "next run");
}

TEST(AtomicFile, SaysWhenAnotherWriterHasTheName) {
  const test::TemporaryFolder folder;
  const fs::path name = folder.path() / "out.txt";
  AtomicFile first = must(AtomicFile::open(name));
  const auto second = AtomicFile::open(name);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message().find("another program is writing it"), std::string::npos);
  must(first.write("first"));
  must(first.close());
  EXPECT_EQ(content(name), "first");
}

TEST(AtomicFile, KeepsTheModeOfTheFileItReplacesAndTheLinkItGoesThrough) {
  const test::TemporaryFolder folder;
  const fs::path real = folder.path() / "real.txt";
  const fs::path link = folder.path() / "link.txt";
  must(write_file(real, "old"));
  fs::permissions(real, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink(real, link);
  must(write_file(link, "new"));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content(real), "new");
  EXPECT_EQ(fs::status(real).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(AtomicFile, TellsOfAFullDeviceAndDoesNotReplaceTheDevice) {
  if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Result<void> written = write_file("/dev/full", "anything");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message().find("No space left"), std::string::npos) << written.error().message();
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

/// Lets no file of this process grow beyond a size, as a full disk or a quota would.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    rlimit tiny = old_;
    tiny.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &tiny);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST(AtomicFile, LeavesNothingOfAFileThatDidNotFit) {
  const test::TemporaryFolder folder;
  const fs::path name = folder.path() / "big.bin";
  Result<void> written;
  {
    const FileSizeLimit limit(4096);
    written = write_file(name, std::string(1 << 20, 'x'));
  }
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message().find(name.string()), std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(AtomicFile, NamesWhatIsWrongWithTheTarget) {
  const test::TemporaryFolder folder;
  const auto in_folder = AtomicFile::open(folder.path());
  ASSERT_FALSE(in_folder);
  EXPECT_NE(in_folder.error().message().find("is a folder"), std::string::npos);
  const auto nowhere = AtomicFile::open(folder.path() / "absent" / "out.txt");
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message().find("make its folder first"), std::string::npos);
  EXPECT_FALSE(AtomicFile::open(""));
}

TEST(ReadFile, RefusesFoldersAbsentFilesAndSizesBeyondTheLimit) {
  const test::TemporaryFolder folder;
  const fs::path name = folder.path() / "three.bin";
  must(write_file(name, std::string(3 << 20, 'x')));
  EXPECT_EQ(must(read_file(name, 3 << 20)).size(), 3u << 20);
  EXPECT_FALSE(read_file(name, (3 << 20) - 1));
  EXPECT_FALSE(read_file(folder.path(), 100));
  EXPECT_FALSE(read_file(folder.path() / "absent", 100));
}

}  // namespace
}  // namespace mstsl::io
