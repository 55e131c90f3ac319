#include "mstsl/eval/paper_protocol.hpp"

#include <gtest/gtest.h>

#include "mstsl/eval/protocol_report.hpp"

#include "test_support.hpp"
#include "thread_crew.hpp"

namespace mstsl {
namespace {

using test::must;

PaperProtocolOptions small_paper() {
  PaperProtocolOptions options;
  options.seed = 52;
  options.waypoints = 2;
  options.runs_per_waypoint = 2;
  options.models = {FieldModel::kFingerprint};
  options.survey.survey.lane_spacing_m = 2.0;
  return options;
}

TEST(PaperProtocol, ComesToTheSameInOneGoAndAfterAnInterruptionAndByTwo) {
  const ProtocolResult whole = must(run_paper_protocol(small_paper()));
  ASSERT_EQ(whole.runs.size(), 4u);
  EXPECT_EQ(whole.traces.size(), 2u);
  EXPECT_GT(whole.runs[0].evaluation.estimates, 10u);

  const test::TemporaryFolder folder;
  PaperProtocolOptions options = small_paper();
  options.folder = folder.path();
  options.threads = {1};
  options.progress = [](const char* what, double) { return std::string_view(what) != "runs"; };
  const auto stopped = run_paper_protocol(options);
  ASSERT_FALSE(stopped);
  EXPECT_NE(stopped.error().message().find("1 of 4"), std::string::npos) << stopped.error().message();

  std::vector<std::string> json(2);
  test::as_crew(2, [&](const Crew& crew) {
    PaperProtocolOptions mine = small_paper();
    mine.folder = folder.path();
    mine.crew = crew;
    json[static_cast<std::size_t>(crew.rank)] = protocol_json(must(run_paper_protocol(mine)));
  });
  EXPECT_EQ(json[0], protocol_json(whole));
  EXPECT_EQ(json[1], protocol_json(whole));
}

TEST(PaperProtocol, SaysWhatItCannotDo) {
  PaperProtocolOptions options = small_paper();
  options.world = "atlantis";
  EXPECT_FALSE(run_paper_protocol(options));
}

}  // namespace
}  // namespace mstsl
