#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "mstsl/io/file_bytes.hpp"

#include "run_app.hpp"
#include "test_support.hpp"

namespace mstsl::test {
namespace {

namespace fs = std::filesystem;

const std::string kSmall =
    "bench --protocol hard --worlds office --cases sparse-survey --runs 2 --length 3 --beams 181 --method "
    "joint "
    "--replays 1 --seed 51 --threads 1 -o ";

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
  const Printed alone = run_app(kSmall + one.string());
  ASSERT_EQ(alone.exit_status, 0) << alone.text;
  const Printed shared = run_shell(mpirun(2, std::string(MSTSL_APP) + " " + kSmall + two.string()));
  ASSERT_EQ(shared.exit_status, 0) << shared.text;
  for (const char* name : {"results_fix.json", "hard_fix_worlds.svg", "hard_fix_distance.svg",
                           "hard_fix_errors.svg", "hard_fix_disturbances.svg", "hard_fix_reliability.svg"})
    EXPECT_EQ(content(one / name), content(two / name)) << name;
  EXPECT_TRUE(fs::exists(two / "runs.1.jsonl")) << "the other did nothing";
  EXPECT_NE(content(one / "hard_fix_worlds.svg").find("<svg"), std::string::npos);
}

TEST(Bench, AFailureOfOneIsToldOnce) {
  if (std::string(MSTSL_MPIRUN).empty()) GTEST_SKIP() << "built without MPI";
  const Printed failed = run_shell(mpirun(2, std::string(MSTSL_APP) + " " + kSmall + "/proc/nowhere"));
  EXPECT_NE(failed.exit_status, 0);
  const std::string said = "mstsl: /proc/nowhere";
  const auto first = failed.text.find(said);
  EXPECT_NE(first, std::string::npos) << failed.text;
  EXPECT_EQ(failed.text.find(said, first + 1), std::string::npos) << failed.text;
}

TEST(Bench, RefusesToBeStartedSeveralTimesWithoutMpi) {
  if (!std::string(MSTSL_MPIRUN).empty()) GTEST_SKIP() << "built with MPI";
  const Printed refused =
      run_shell("OMPI_COMM_WORLD_SIZE=2 " + std::string(MSTSL_APP) + " " + kSmall + "/nowhere");
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_TRUE(refused.says("MSTSL_WITH_MPI")) << refused.text;
}

}  // namespace
}  // namespace mstsl::test
