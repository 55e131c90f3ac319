#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command_line.hpp"
#include "interrupt.hpp"
#include "run_picture.hpp"
#include "session.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

struct DemoWish {
  fs::path output = "mstsl-demo";
  int runs = 3;
  /// A tenth of the paper's: one quick pass over every lane.
  std::size_t fingerprints = 10'000;
};

/// The files of a folder whose names begin and end so, in their order.
std::vector<fs::path> files_like(const fs::path& folder, std::string_view beginning,
                                 std::string_view ending) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(beginning) && name.ends_with(ending)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Words operator+(Words words, const std::vector<fs::path>& files) {
  for (const fs::path& file : files) words.push_back(file.string());
  return words;
}

/// Runs one command as it would be typed, and shows it. Errors: it failed; that a run ended without a fix is
/// none.
Result<void> type(const Session& session, Words words, std::string_view what) {
  if (!session.quiet) {
    fmt::print("\n\033[1m{}\033[0m\n$ mstsl {}\n", what, fmt::join(words, " "));
    std::fflush(stdout);
  }
  if (session.quiet && words.front() != "evaluate") words.emplace_back("--quiet");
  words.insert(words.end(), {"--threads", std::to_string(session.threads.count)});
  const int status = run_command_line(words);
  if (interrupted()) return Error("the demonstration was interrupted");
  if (status == static_cast<int>(Exit::kDone) || status == static_cast<int>(Exit::kNoFix)) return {};
  return Error(fmt::format("the demonstration ended because `mstsl {}` failed", words.front()));
}

Result<Exit> demo(const Session& session, const DemoWish& wish) {
  const fs::path& folder = wish.output;
  const std::string map = folder / "map.yaml", field = folder / "field.nc";
  if (auto done = type(
          session,
          {"simulate", "--world", "corridor", "--seed", std::to_string(session.seed), "--fingerprints",
           std::to_string(wish.fingerprints), "--runs", std::to_string(wish.runs), "-o", folder.string()},
          "1. Simulate a symmetric corridor loop: its map, a survey, some runs");
      !done)
    return done.error();
  if (auto done = type(session,
                       Words{"map", "magnetic", "--map", map, "--pose-topic", "/ground_truth", "-o", field} +
                           files_like(folder, "survey_", ".mcap"),
                       "2. Map the magnetic field from the survey");
      !done)
    return done.error();

  std::vector<fs::path> truths, estimates;
  const std::vector<fs::path> logs = files_like(folder, "run_", ".mcap");
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const std::string number = logs[i].stem().string().substr(4);
    truths.push_back(folder / fmt::format("truth_{}.csv", number));
    estimates.push_back(folder / fmt::format("estimates_{}.jsonl", number));
    if (auto done = type(
            session,
            {"localize", "--map", map, "--field", field, "-o", estimates.back().string(), logs[i].string()},
            fmt::format("3. Localize run {} of {}", i + 1, logs.size()));
        !done)
      return done.error();
  }
  if (logs.empty()) return Error(folder.string() + ": the simulator left no run there");

  Words evaluation{"evaluate"};
  for (const fs::path& truth : truths) evaluation.insert(evaluation.end(), {"--truth", truth.string()});
  if (auto done = type(session, std::move(evaluation) + estimates, "4. Hold the estimates against the truth");
      !done)
    return done.error();
  const fs::path picture = folder / "demo.png";
  if (auto done = write_run_picture({map, field, estimates.front(), truths.front()},
                                    "Where am I? Magnetic field, LiDAR and odometry in a symmetric building",
                                    picture);
      !done)
    return done.error();
  if (!session.quiet)
    fmt::print("\nresults: {}\npicture of the first run: {}\n", folder.string(), picture.string());
  return Exit::kDone;
}

}  // namespace

void add_demo(CLI::App& app, Session& session) {
  auto wish = std::make_shared<DemoWish>();
  CLI::App* command =
      app.add_subcommand("demo", "Simulate, survey, map, localize and show: the whole system in one go");
  command->add_option("-o,--output", wish->output, "Folder for all results")->capture_default_str();
  command->add_option("--runs", wish->runs, "How many runs to localize")
      ->check(CLI::Range(1, 99))
      ->capture_default_str();
  command->add_option("--fingerprints", wish->fingerprints, "How many fingerprints to survey")
      ->check(CLI::Range(1000, 10'000'000))
      ->capture_default_str();
  add_common_options(*command, session);
  command->callback([wish, &session] { session.work = [wish, &session] { return demo(session, *wish); }; });
}

}  // namespace mstsl::app
