#include <filesystem>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "mstsl/core/trajectory.hpp"
#include "mstsl/eval/summary_report.hpp"
#include "mstsl/io/estimates.hpp"
#include "mstsl/io/truth.hpp"

#include "session.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

struct EvaluateWish {
  std::vector<fs::path> truths;
  std::vector<fs::path> estimates;
};

Result<Trajectory> load_truth(const fs::path& file) {
  const auto poses = io::read_truth(file);
  if (!poses) return poses.error();
  Trajectory truth;
  for (const PoseReading& pose : *poses) truth.add(pose.stamp, pose.map_T_base);
  return truth;
}

Result<RunEvaluation> evaluate_file(const fs::path& truth_file, const fs::path& estimates_file) {
  const Result<Trajectory> truth = load_truth(truth_file);
  if (!truth) return truth.error();
  const auto estimates = io::read_estimates(estimates_file);
  if (!estimates) return estimates.error();
  RunEvaluation run = evaluate_run(estimates->estimates, *truth);
  if (run.estimates > 0 && run.without_truth == run.estimates)
    return Error(fmt::format("{}: its times are not those of {}; give it the truth of this very run",
                             estimates_file.string(), truth_file.string()));
  return run;
}

Result<Exit> evaluate(const Session& session, const EvaluateWish& wish) {
  const bool one_for_all = wish.truths.size() == 1;
  if (!one_for_all && wish.truths.size() != wish.estimates.size())
    return Error(
        fmt::format("{} truths for {} files of estimates; give one for all, or one for each, in their order",
                    wish.truths.size(), wish.estimates.size()));
  std::vector<RunEvaluation> runs;
  for (std::size_t i = 0; i < wish.estimates.size(); ++i) {
    Result<RunEvaluation> run = evaluate_file(wish.truths[one_for_all ? 0 : i], wish.estimates[i]);
    if (!run) return run.error();
    runs.push_back(std::move(run).value());
  }
  const Summary summary = summarise(runs);
  if (session.json)
    fmt::print("{}\n", to_json(summary));
  else
    fmt::print("{}", to_text(summary));
  return Exit::kDone;
}

}  // namespace

void add_evaluate(CLI::App& app, Session& session) {
  auto wish = std::make_shared<EvaluateWish>();
  CLI::App* command = app.add_subcommand("evaluate", "Hold estimates against the truth");
  command
      ->add_option(
          "--truth", wish->truths,
          "True poses, CSV with t,x,y,yaw; give it once for all estimates, or once for each in their order")
      ->required()
      ->allow_extra_args(false);  // one a flag: what follows are the estimates
  command->add_option("estimates", wish->estimates, "Files of estimates, one a run")->required();
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return evaluate(session, *wish); }; });
}

}  // namespace mstsl::app
