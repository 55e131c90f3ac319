#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "mstsl/eval/paper_protocol.hpp"

#include "bench_hard.hpp"
#include "bench_mapping.hpp"
#include "bench_paper.hpp"
#include "bench_real.hpp"
#include "processes.hpp"
#include "session.hpp"

namespace mstsl::app {
namespace {

struct Wish {
  std::string protocol = "paper";
  std::filesystem::path output;
  int runs = PaperProtocolOptions{}.runs_per_waypoint;
  PaperWish paper;
  HardWish hard;
  MappingWish mapping;
  RealWish real;
};

Result<Exit> run_protocol(const Session& session, const Wish& wish) {
  if (wish.protocol == "hard") return bench_hard(session, wish.hard, wish.runs, wish.output);
  if (wish.protocol == "mapping")
    return bench_mapping(session, wish.mapping, wish.hard.worlds, wish.runs, wish.output);
  if (wish.protocol == "real") return bench_real(session, wish.real, wish.hard.methods, wish.output);
  return bench_paper(session, wish.paper, wish.runs, wish.output);
}

/// As one of the processes that mpirun started, if it did. The leader speaks for all.
Result<Exit> bench(Session session, const Wish& wish) {
  const Result<Processes> processes = Processes::join();
  if (!processes) return processes.error();
  session.crew = processes->crew();
  if (session.crew.leads()) return run_protocol(session, wish);
  session.quiet = true, session.json = false;
  const Result<Exit> mine = run_protocol(session, wish);
  return mine ? *mine : Exit::kFailed;
}

}  // namespace

void add_bench(CLI::App& app, Session& session) {
  auto wish = std::make_shared<Wish>();
  CLI::App* command = app.add_subcommand("bench", "Measure the methods by a fixed protocol");
  command
      ->add_option(
          "--protocol", wish->protocol,
          "paper: ten starts driven ten times each, as in the paper; hard: symmetric buildings and "
          "whatever disturbs a robot; mapping: maps made from drives, by scans alone and with the field; "
          "real: recordings of real buildings")
      ->check(CLI::IsMember({"paper", "hard", "mapping", "real"}))
      ->capture_default_str();
  command->add_option("-o,--output", wish->output, "Folder for report, tables, runs and curves")->required();
  command->add_option("--runs", wish->runs, "Runs from each start; hard: of each building and case")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  add_paper_options(*command, wish->paper);
  add_hard_options(*command, wish->hard);
  add_mapping_options(*command, wish->mapping);
  add_real_options(*command, wish->real);
  add_common_options(*command, session);
  command->callback([wish, &session] { session.work = [wish, &session] { return bench(session, *wish); }; });
}

}  // namespace mstsl::app
