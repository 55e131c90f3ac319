#include "command_line.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "interrupt.hpp"
#include "session.hpp"

namespace mstsl::app {

void add_common_options(CLI::App& command, Session& session) {
  command
      .add_option("--threads", session.threads.count,
                  "Threads to use; 0 takes all cores. Never changes results")
      ->check(CLI::Range(0, 1024));
  command.add_option("--seed", session.seed, "Seed of everything random")->capture_default_str();
  command.add_flag("--quiet", session.quiet, "Print errors only");
  command.add_flag("--json", session.json, "Print the result as one JSON object on stdout");
}

int fail(const std::string& sentence) {
  fmt::print(stderr, "mstsl: {}\n", sentence);
  return static_cast<int>(Exit::kFailed);
}

int run_command_line(const std::vector<std::string>& arguments) {
  CLI::App app("Tells a mobile robot where it is, in buildings that look alike", "mstsl");
  app.set_version_flag("--version", MSTSL_VERSION);
  app.require_subcommand(1);
  Session session;
  for (const auto add :
       {add_demo, add_simulate, add_map, add_localize, add_evaluate, add_bench, add_convert, add_info})
    add(app, session);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    app.exit(error);
    return static_cast<int>(asked_for_help ? Exit::kDone : Exit::kWrongUsage);
  }
  stop_on_interrupt();
  const Result<Exit> exit = session.work();
  return exit ? static_cast<int>(*exit) : fail(exit.error().message());
}

}  // namespace mstsl::app
