#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "mstsl/io/file_bytes.hpp"

#include "run_app.hpp"
#include "test_support.hpp"

namespace mstsl::test {
namespace {

namespace fs = std::filesystem;

const std::string kDrives =
    "bench --protocol mapping --worlds office --runs 1 --way 40 --seed 51 --threads 1 -o ";
const std::string kRuns =
    "bench --protocol hard --worlds office --cases sparse-survey --runs 1 --length 2 --beams 91 --method "
    "joint "
    "--replays 0 --seed 51 -o ";

std::string content(const fs::path& file) { return must(io::read_file(file, std::size_t{1} << 28)); }

/// mpirun as any of its makers and any user may call it here.
std::string mpirun(int processes, const std::string& command) {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 " +
         std::string(MSTSL_MPIRUN) + " -n " + std::to_string(processes) + " " + command;
}

TEST(Bench, SeveralProcessesMakeTheSameResultsAsOne) {
  if (std::string(MSTSL_MPIRUN).empty()) GTEST_SKIP() << "built without MPI";
  const TemporaryFolder folder;
  const fs::path one = folder.path() / "one", two = folder.path() / "two";
  const Printed alone = run_app(kDrives + one.string());
  ASSERT_EQ(alone.exit_status, 0) << alone.text;
  const Printed shared = run_shell(mpirun(2, std::string(MSTSL_APP) + " " + kDrives + two.string()));
  ASSERT_EQ(shared.exit_status, 0) << shared.text;
  EXPECT_EQ(content(one / "mapping.json"), content(two / "mapping.json"));
  EXPECT_TRUE(fs::exists(two / "runs.1.jsonl")) << "the other did nothing";
}

TEST(Bench, HardLeavesTablesFiguresAndAPage) {
  const TemporaryFolder folder;
  const Printed made = run_app(kRuns + folder.path().string());
  ASSERT_EQ(made.exit_status, 0) << made.text;
  EXPECT_TRUE(made.says("right poses withdrawn")) << made.text;
  for (const char* name : {"worlds", "disturbances", "distance", "errors", "reliability"}) {
    const fs::path figure = folder.path() / ("hard_fix_" + std::string(name) + ".svg");
    EXPECT_NE(content(figure).find("<svg"), std::string::npos) << name;
  }
  EXPECT_NE(content(folder.path() / "report_fix.html").find("</html>"), std::string::npos);
  EXPECT_NE(content(folder.path() / "results_fix.json").find("\"success\""), std::string::npos);
}

TEST(Bench, AFailureOfOneIsToldOnce) {
  if (std::string(MSTSL_MPIRUN).empty()) GTEST_SKIP() << "built without MPI";
  const Printed failed = run_shell(mpirun(2, std::string(MSTSL_APP) + " " + kDrives + "/proc/nowhere"));
  EXPECT_NE(failed.exit_status, 0);
  const std::string said = "mstsl: /proc/nowhere";
  const auto first = failed.text.find(said);
  EXPECT_NE(first, std::string::npos) << failed.text;
  EXPECT_EQ(failed.text.find(said, first + 1), std::string::npos) << failed.text;
}

TEST(Bench, RefusesToBeStartedSeveralTimesWithoutMpi) {
  if (!std::string(MSTSL_MPIRUN).empty()) GTEST_SKIP() << "built with MPI";
  const Printed refused =
      run_shell("OMPI_COMM_WORLD_SIZE=2 " + std::string(MSTSL_APP) + " " + kDrives + "/nowhere");
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_TRUE(refused.says("MSTSL_WITH_MPI")) << refused.text;
}

}  // namespace
}  // namespace mstsl::test
