#include <algorithm>

#include <gtest/gtest.h>

#include "bag_support.hpp"
#include "io/bag/bag_log.hpp"
#include "recording_support.hpp"

namespace mstsl::io {
namespace {

using test::BagBuilder;
using test::must;

struct Seen {
  std::vector<std::string> messages;
  PlayReport report;
};

Seen read_all(
    const std::string& bytes, const MessageLog::Wanted& wanted = [](const Channel&) { return true; },
    bool look_ahead = false) {
  auto log = must(open_bag(InputFile::in_memory(as_bytes(bytes))));
  Seen seen;
  const auto visit = [&seen](const RawMessage& message) {
    seen.messages.push_back(message.channel->topic + " " + std::string(as_text(message.data)));
    return true;
  };
  log->read(wanted, visit, look_ahead ? nullptr : &seen.report);
  return seen;
}

/// Ten chunks of two topics, and a third topic in the last chunk only.
std::string make_bag(BagBuilder::Options options, std::vector<std::string>& written) {
  BagBuilder bag(options);
  bag.connect(0, "/a", "std_msgs/String");
  bag.connect(1, "/b", "std_msgs/String");
  for (int chunk = 0; chunk < 10; ++chunk) {
    if (chunk == 9) bag.connect(2, "/late", "std_msgs/Int32");
    for (int i = 0; i < 20; ++i) {
      const std::uint32_t id = chunk == 9 && i == 10 ? 2 : static_cast<std::uint32_t>(i % 2);
      const std::string data = "message " + std::to_string(100 * chunk + i);
      bag.write(id, Stamp::from_parts(1000 + chunk, i), data);
      written.push_back((id == 0 ? "/a " : id == 1 ? "/b " : "/late ") + data);
    }
    bag.end_chunk();
  }
  return bag.finish();
}

class Bag : public testing::TestWithParam<BagBuilder::Options> {};

TEST_P(Bag, GivesBackItsMessages) {
  std::vector<std::string> written;
  const std::string bytes = make_bag(GetParam(), written);
  const Seen seen = read_all(bytes);
  EXPECT_EQ(seen.messages, written);
  EXPECT_TRUE(seen.report.problems.empty());
  EXPECT_EQ(test::warns_of(seen.report, "never closed"), !GetParam().indexed);
}

TEST_P(Bag, KnowsItsChannelsAndTimes) {
  std::vector<std::string> written;
  const std::string bytes = make_bag(GetParam(), written);
  const auto log = must(open_bag(InputFile::in_memory(as_bytes(bytes))));
  ASSERT_EQ(log->channels().size(), 3U);
  EXPECT_EQ(log->channels()[2].topic, "/late");
  EXPECT_EQ(log->channels()[2].type, "std_msgs/Int32");
  EXPECT_EQ(log->channels()[2].message_count, 1U);
  EXPECT_EQ(log->channels()[0].message_count, 99U);
  EXPECT_EQ(log->time_span()->first, Stamp::from_parts(1000, 0));
  EXPECT_EQ(log->time_span()->last, Stamp::from_parts(1009, 19));
}

TEST_P(Bag, FindsATopicThatBeginsLate) {
  std::vector<std::string> written;
  const std::string bytes = make_bag(GetParam(), written);
  const auto late = [](const Channel& channel) { return channel.topic == "/late"; };
  for (const bool look_ahead : {false, true})
    EXPECT_EQ(read_all(bytes, late, look_ahead).messages, (std::vector<std::string>{"/late message 910"}));
}

TEST_P(Bag, CutAnywhereGivesItsFirstMessages) {
  std::vector<std::string> written;
  const std::string bytes = make_bag(GetParam(), written);
  for (std::size_t size = 13; size < bytes.size(); size += 97) {
    const Seen seen = read_all(bytes.substr(0, size));
    ASSERT_LE(seen.messages.size(), written.size());
    ASSERT_TRUE(std::equal(seen.messages.begin(), seen.messages.end(), written.begin())) << size << " bytes";
    EXPECT_EQ(seen.report.warnings.size(), 1U) << size << " bytes";
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, Bag,
                         testing::Values(BagBuilder::Options{true, true}, BagBuilder::Options{true, false},
                                         BagBuilder::Options{false, false}),
                         [](const auto& layout) {
                           return std::string(layout.param.chunked ? "Chunked" : "Flat") +
                                  (layout.param.indexed ? "Indexed" : "Unindexed");
                         });

TEST(BagDamage, CostsOneChunkWhenThereIsAnIndex) {
  std::vector<std::string> written;
  std::string bytes = make_bag({true, true}, written);
  const std::size_t third = bytes.find("compression=none", bytes.find("compression=none", 4200) + 1);
  bytes[third - 14] = '\x7F';  // within the record's header: its first field's length
  const Seen seen = read_all(bytes);
  EXPECT_EQ(seen.messages.size(), written.size() - 20);
  EXPECT_EQ(seen.messages.back(), written.back());
  EXPECT_EQ(test::problems(seen.report, "damaged stretches skipped"), 1U);
}

TEST(BagDamage, OtherVersionsAreRefusedWithAMend) {
  const std::string old = "#ROSBAG V1.2\n and so on";
  EXPECT_TRUE(is_bag(InputFile::in_memory(as_bytes(old))));
  const auto log = open_bag(InputFile::in_memory(as_bytes(old)));
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().message().find("rosbag migrate"), std::string::npos);
}

TEST(BagDamage, AnIndexThatPointsNowhereIsNotUsed) {
  std::vector<std::string> written;
  std::string bytes = make_bag({true, true}, written);
  const std::size_t place = bytes.find("index_pos=") + 10;
  bytes[place + 7] = '\x7F';
  EXPECT_EQ(read_all(bytes).messages, written);
}

}  // namespace
}  // namespace mstsl::io
