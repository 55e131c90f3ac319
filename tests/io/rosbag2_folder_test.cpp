#include <gtest/gtest.h>

#include "mstsl/io/recording_info.hpp"

#include "message_support.hpp"

namespace mstsl::test {
namespace {

constexpr const char* kMetadata =
    "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
    "  relative_file_paths:\n    - drive_0.mcap\n    - drive_1.mcap\n"
    "  compression_format: \"\"\n  compression_mode: \"\"\n";

/// A drive that the recorder split in two, the mountings in the first file only.
class Rosbag2Folder : public testing::Test {
 protected:
  Rosbag2Folder() {
    UsualLog first(folder() / "drive_0.mcap");
    first.begin(100.0);
    for (int i = 1; i < 10; ++i) first.put(ros_odometry(100.0 + 0.1 * i, 0.1 * i), 100.0 + 0.1 * i);
    first.close();
    UsualLog second(folder() / "drive_1.mcap");
    for (int i = 10; i < 20; ++i) second.put(ros_odometry(100.0 + 0.1 * i, 0.1 * i), 100.0 + 0.1 * i);
    second.close();
  }
  const std::filesystem::path& folder() const { return folder_.path(); }
  void describe(std::string metadata) const { write_bytes(folder() / "metadata.yaml", metadata); }
  std::string error() const { return try_play({folder()}).error().message(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(Rosbag2Folder, IsOneRecordingWithoutARestart) {
  describe(kMetadata);
  const Played played = play_all({folder()});
  EXPECT_EQ(played.of<OdometryReading>().size(), 20U);
  EXPECT_TRUE(played.of<OdometryRestart>().empty());
  EXPECT_TRUE(played.report.warnings.empty());
  EXPECT_EQ(must(io::describe_recording(folder())).format, "rosbag2 folder");
  EXPECT_EQ(must(io::describe_recording(folder())).topics.size(), 6U);
}

TEST_F(Rosbag2Folder, NeedsNoMetadataWhenTheRecorderWasKilled) {
  EXPECT_EQ(play_all({folder()}).of<OdometryReading>().size(), 20U);
}

TEST_F(Rosbag2Folder, NamesAFileThatIsMissing) {
  describe(kMetadata);
  std::filesystem::remove(folder() / "drive_1.mcap");
  EXPECT_NE(error().find("drive_1.mcap: cannot be opened"), std::string::npos) << error();
}

TEST_F(Rosbag2Folder, RefusesOtherStoragesWithAMend) {
  describe(
      "rosbag2_bagfile_information:\n  storage_identifier: sqlite3\n  relative_file_paths: [drive_0.db3]\n");
  EXPECT_NE(error().find("'sqlite3', but only mcap is read; convert"), std::string::npos) << error();
  describe("rosbag2_bagfile_information:\n  storage_identifier: mcap\n  compression_mode: FILE\n");
  EXPECT_NE(error().find("compression_mode: FILE"), std::string::npos) << error();
}

TEST_F(Rosbag2Folder, RefusesBrokenMetadata) {
  for (const char* metadata :
       {"", "[1, 2", "a: b", "rosbag2_bagfile_information: 3", "- 1\n- 2\n",
        "rosbag2_bagfile_information:\n  storage_identifier: mcap\n  relative_file_paths: {a: 1}",
        "rosbag2_bagfile_information:\n  storage_identifier: mcap\n  relative_file_paths: [[1]]"}) {
    describe(metadata);
    EXPECT_NE(error().find(folder().string()), std::string::npos) << metadata << ": " << error();
  }
}

TEST_F(Rosbag2Folder, RefusesAFolderWithoutLogs) {
  const TemporaryFolder empty;
  const auto played = try_play({empty.path()});
  ASSERT_FALSE(played.ok());
  EXPECT_NE(played.error().message().find("folder without MCAP files"), std::string::npos);
}

}  // namespace
}  // namespace mstsl::test
