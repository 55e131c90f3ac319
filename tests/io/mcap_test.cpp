#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "io/compression.hpp"
#include "io/mcap/mcap_log.hpp"
#include "io/mcap/records.hpp"
#include "io/mcap/summary.hpp"
#include "io/mcap/writer.hpp"
#include "recording_support.hpp"

namespace mstsl::io {
namespace {

using test::must;

/// Messages as text, to compare what went in with what comes out.
struct Seen {
  std::vector<std::string> messages;
  PlayReport report;
};

Seen read_all(
    const std::string& bytes, const MessageLog::Wanted& wanted = [](const Channel&) { return true; }) {
  auto log = must(open_mcap(InputFile::in_memory(as_bytes(bytes))));
  Seen seen;
  log->read(
      wanted,
      [&seen](const RawMessage& message) {
        seen.messages.push_back(message.channel->topic + " " + std::to_string(message.log_time.ns) + " " +
                                std::string(as_text(message.data)));
        return true;
      },
      &seen.report);
  return seen;
}

class Mcap : public testing::Test {
 protected:
  /// A file with `count` messages of up to `largest` random bytes on two topics.
  std::string write(std::size_t count, std::size_t largest) {
    auto writer = must(mcap::Writer::open(path(), "ros2", "test"));
    const auto schema = writer.add_schema("std_msgs/msg/String", "ros2msg", "string data\n");
    const std::uint16_t channels[] = {writer.add_channel(schema, "/a", "cdr", {{"key", "value"}}),
                                      writer.add_channel(schema, "/b", "cdr", {})};
    for (std::size_t i = 0; i < count; ++i) {
      std::string data(random_.index(largest + 1), ' ');
      for (char& c : data) c = static_cast<char>('a' + random_.index(26));
      const std::size_t topic = random_.index(2);
      must(writer.write(channels[topic], 1000 + i, as_bytes(data)));
      written_.push_back((topic == 0 ? "/a " : "/b ") + std::to_string(1000 + i) + " " + data);
    }
    must(writer.close());
    return test::read_bytes(path());
  }
  std::filesystem::path path() const { return folder_.path() / "file.mcap"; }

  test::TemporaryFolder folder_;
  Random random_{5};
  std::vector<std::string> written_;
};

TEST_F(Mcap, MessagesCrossTheBordersOfChunksUnchanged) {
  const std::string file = write(400, 40'000);  // eight chunks
  const Seen seen = read_all(file);
  EXPECT_EQ(seen.messages, written_);
  EXPECT_TRUE(seen.report.problems.empty());
  EXPECT_TRUE(seen.report.warnings.empty());
  EXPECT_GT(mcap::summarize(InputFile::in_memory(as_bytes(file))).chunks.size(), 4U);
}

TEST_F(Mcap, MessagesLargerThanAChunkComeBack) {
  const std::string file = write(5, 3'000'000);
  EXPECT_EQ(read_all(file).messages, written_);
}

TEST_F(Mcap, AnEmptyFileIsWhole) {
  const Seen seen = read_all(write(0, 0));
  EXPECT_TRUE(seen.messages.empty());
  EXPECT_TRUE(seen.report.warnings.empty());
}

TEST_F(Mcap, OnlyWantedChannelsAreVisited) {
  const Seen seen = read_all(write(100, 50), [](const Channel& channel) { return channel.topic == "/b"; });
  std::erase_if(written_, [](const std::string& message) { return message.starts_with("/a"); });
  EXPECT_EQ(seen.messages, written_);
}

TEST_F(Mcap, TheSummaryCountsWhatIsThere) {
  const mcap::Summary summary = mcap::summarize(InputFile::in_memory(as_bytes(write(300, 20'000))));
  EXPECT_EQ(summary.statistics.message_count, 300U);
  EXPECT_EQ(summary.statistics.chunk_count, summary.chunks.size());
  EXPECT_EQ(summary.statistics.start_time, 1000U);
  EXPECT_EQ(summary.statistics.end_time, 1299U);
  EXPECT_EQ(summary.channels.at(1).metadata.at("key"), "value");
  EXPECT_NE(summary.data_crc, 0U);
}

TEST_F(Mcap, AFileCutAnywhereGivesItsFirstMessagesAndSaysSo) {
  const std::string file = write(150, 30'000);
  std::size_t last_count = 0;
  for (std::size_t size = 8; size < file.size(); size += file.size() / 200) {
    const Seen seen = read_all(file.substr(0, size));
    ASSERT_LE(seen.messages.size(), written_.size());
    ASSERT_TRUE(std::equal(seen.messages.begin(), seen.messages.end(), written_.begin())) << size << " bytes";
    EXPECT_GE(seen.messages.size(), last_count) << size << " bytes";
    last_count = seen.messages.size();
    const bool is_whole = seen.messages.size() == written_.size();
    EXPECT_TRUE(is_whole || test::warns_of(seen.report, "ends in the middle")) << size << " bytes";
  }
  EXPECT_EQ(last_count, written_.size());
}

TEST_F(Mcap, AFileCutAtEvery97thByteNeverHarms) {
  const std::string file = write(40, 600);
  for (std::size_t size = 8; size < file.size(); size += 97) {
    const Seen seen = read_all(file.substr(0, size));
    ASSERT_TRUE(std::equal(seen.messages.begin(), seen.messages.end(), written_.begin()));
  }
}

TEST_F(Mcap, AChunkWithAFlippedBitIsLeftOutAndCounted) {
  std::string file = write(300, 40'000);
  const mcap::Summary summary = mcap::summarize(InputFile::in_memory(as_bytes(file)));
  const mcap::ChunkIndex& second = std::next(summary.chunks.begin())->second;
  file[second.chunk_offset + second.chunk_size - 100] ^= 1;
  const Seen seen = read_all(file);
  EXPECT_LT(seen.messages.size(), written_.size());
  EXPECT_GT(seen.messages.size(), written_.size() / 2);
  EXPECT_EQ(test::problems(seen.report, "chunks"), 1U);
  EXPECT_TRUE(test::warns_of(seen.report, "the check sum of its data"));
  for (const std::string& message : seen.messages)
    EXPECT_TRUE(std::ranges::find(written_, message) != written_.end());
}

TEST_F(Mcap, ABrokenLengthCostsOneChunkWhenThereIsAnIndex) {
  std::string file = write(300, 40'000);
  const mcap::Summary summary = mcap::summarize(InputFile::in_memory(as_bytes(file)));
  const std::uint64_t second = std::next(summary.chunks.begin())->first;
  file[second + 7] = '\x7F';  // the chunk's length becomes astronomical
  const Seen seen = read_all(file);
  EXPECT_GT(seen.messages.size(), written_.size() / 2);
  EXPECT_EQ(seen.messages.back(), written_.back());
  EXPECT_EQ(test::problems(seen.report, "damaged stretches skipped"), 1U);
}

TEST_F(Mcap, ADamagedSummaryIsReplacedByAPassOverTheFile) {
  std::string file = write(100, 100);
  file[file.size() - 60] ^= 1;
  const Seen seen = read_all(file);
  EXPECT_EQ(seen.messages, written_);
  EXPECT_TRUE(test::warns_of(seen.report, "index at the end of the log is damaged"));
}

TEST_F(Mcap, UnknownRecordsArePassedOver) {
  const std::string file = write(10, 100);
  ByteBuilder unknown;
  unknown.number(std::uint8_t{0x9C});
  unknown.sized<std::uint64_t>(as_bytes("from a later version"));
  // Behind the header record: magic, opcode, length, "ros2", "test".
  const std::size_t place = 8 + 9 + 8 + 8;
  const Seen seen =
      read_all(file.substr(0, place) + std::string(as_text(unknown.bytes())) + file.substr(place));
  EXPECT_EQ(seen.messages, written_);
}

/// A file by hand, from the specification, without the writer.
TEST(McapByHand, PlainRecordsOutsideOfChunksAreRead) {
  ByteBuilder out;
  out.append(as_bytes(mcap::kMagic));
  append(out, mcap::Header{"ros1", "hand"});
  append(out, mcap::Schema{7, "std_msgs/String", "ros1msg", "string data"});
  append(out, mcap::Channel{3, 7, "/chatter", "ros1", {}});
  append(out, mcap::Message{3, 0, 55, 55, as_bytes("hello")});
  mcap::append_data_end(out, 0);
  append(out, mcap::Footer{});
  out.append(as_bytes(mcap::kMagic));
  const std::string file(as_text(out.bytes()));
  EXPECT_EQ(read_all(file).messages, (std::vector<std::string>{"/chatter 55 hello"}));
  const auto log = must(open_mcap(InputFile::in_memory(as_bytes(file))));
  EXPECT_EQ(log->channels().at(0).type, "std_msgs/String");
  EXPECT_EQ(log->channels().at(0).encoding, ros::Encoding::kRos1);
  EXPECT_EQ(log->channels().at(0).message_count, 1U);
}

TEST(McapByHand, MessagesOfAChunkAreVisitedInTheOrderOfTheirTimes) {
  ByteBuilder chunk;
  append(chunk, mcap::Schema{1, "std_msgs/msg/String", "ros2msg", "string data"});
  append(chunk, mcap::Channel{1, 1, "/a", "cdr", {}});
  for (const std::uint64_t time : {5, 2, 9, 2, 1})
    append(chunk, mcap::Message{1, 0, time, time, as_bytes("x")});
  ByteBuilder out;
  out.append(as_bytes(mcap::kMagic));
  append(out, mcap::Header{"ros2", "hand"});
  append(out, mcap::Chunk{1, 9, chunk.bytes().size(), 0, "", chunk.bytes().size(), chunk.bytes()});
  mcap::append_data_end(out, 0);
  append(out, mcap::Footer{});
  out.append(as_bytes(mcap::kMagic));
  EXPECT_EQ(read_all(std::string(as_text(out.bytes()))).messages,
            (std::vector<std::string>{"/a 1 x", "/a 2 x", "/a 2 x", "/a 5 x", "/a 9 x"}));
}

TEST(McapByHand, AChunkThatPromisesTooMuchIsNotBelieved) {
  for (const std::uint64_t promised : {std::uint64_t{1} << 29, std::uint64_t{1} << 62}) {
    const Bytes packed = compress_zstd(as_bytes("tiny"));
    ByteBuilder out;
    out.append(as_bytes(mcap::kMagic));
    append(out, mcap::Header{"ros2", "hand"});
    append(out, mcap::Chunk{0, 0, promised, 0, "zstd", packed.size(), packed});
    const Seen seen = read_all(std::string(as_text(out.bytes())));
    EXPECT_TRUE(seen.messages.empty());
    EXPECT_EQ(test::problems(seen.report, "chunks"), 1U);
  }
}

TEST(McapByHand, OtherVersionsAreRefused) {
  const std::string file = "\x89MCAP1\r\n and more";
  EXPECT_FALSE(open_mcap(InputFile::in_memory(as_bytes(file))).ok());
}

}  // namespace
}  // namespace mstsl::io
