#include "mstsl/eval/mapping_protocol.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "test_support.hpp"

namespace mstsl {
namespace {

using test::must;

MappingProtocolOptions small() {
  MappingProtocolOptions options;
  options.worlds = {"office"};
  options.runs = 1;
  options.length_m = 80.0;
  options.seed = 7;
  return options;
}

TEST(MappingProtocol, MapsEachDriveWithAndWithoutTheField) {
  const auto records = must(run_mapping_protocol(small()));
  ASSERT_EQ(records.size(), 4U);  // two robots, each by scans and with the field
  for (const MappingRecord& r : records) {
    EXPECT_EQ(r.world, "office");
    EXPECT_EQ(r.wrong_closures, 0U);
    EXPECT_LT(r.ate_rms_m, 0.3);
    EXPECT_NEAR(r.driven_m, 80.0, 15.0);
    EXPECT_LT(r.map_error, 0.3);
  }
  EXPECT_FALSE(records[0].with_field);
  EXPECT_TRUE(records[1].with_field);
  EXPECT_EQ(records[0].robot, "good");
  EXPECT_EQ(records[2].robot, "cheap");
  const auto json = nlohmann::json::parse(mapping_json(records, small(), "abc"));
  EXPECT_EQ(json.at("runs").size(), 4U);
  EXPECT_EQ(json.at("commit"), "abc");
  EXPECT_NE(mapping_text(records).find("office"), std::string::npos);
}

TEST(MappingProtocol, RefusesWhatThereIsNot) {
  MappingProtocolOptions options = small();
  options.robots = {"golden"};
  EXPECT_FALSE(run_mapping_protocol(options).ok());
  options = small();
  options.worlds = {"atlantis"};
  EXPECT_FALSE(run_mapping_protocol(options).ok());
}

}  // namespace
}  // namespace mstsl
