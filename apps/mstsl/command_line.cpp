#include "command_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "interrupt.hpp"
#include "session.hpp"

namespace mstsl::app {

namespace {

std::string not_a_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? "" : fmt::format("'{}' is no whole number from 0 to 18446744073709551615", text);
}

bool is_number_but_not_finite(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && !std::isfinite(value);
}

/// The options of a command and its groups whose number is NaN or infinite: range checks let NaN through.
std::optional<std::string> not_finite(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    for (const std::string& result : option->results())
      if (option->get_type_name().find("FLOAT") != std::string::npos && is_number_but_not_finite(result))
        return fmt::format("{}: '{}' is no finite number", option->get_name(), result);
  for (const CLI::App* part : command.get_subcommands([](const CLI::App*) { return true; }))
    if (auto found = not_finite(*part)) return found;
  return std::nullopt;
}

/// A sentence where the first word names no command: CLI11 would only say that one is missing.
std::optional<std::string> no_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments[0].starts_with('-')) return std::nullopt;
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == arguments[0]) return std::nullopt;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return fmt::format("'{}' is no command; choose one of {}", arguments[0], names);
}

/// Throws CLI::ParseError on wrong usage.
void parse(CLI::App& app, const std::vector<std::string>& arguments) {
  if (const auto wrong = no_command(app, arguments)) throw CLI::ValidationError(*wrong);
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first
  if (const auto bad = not_finite(app)) throw CLI::ValidationError(*bad);
}

}  // namespace

void add_common_options(CLI::App& command, Session& session) {
  command
      .add_option("--threads", session.threads.count,
                  "Threads to use; 0 takes all cores. Never changes results")
      ->check(CLI::Range(0, 1024));
  command.add_option("--seed", session.seed, "Seed of everything random")
      ->capture_default_str()
      ->check(CLI::Validator(not_a_seed, ""));
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
  for (const auto add : {add_demo, add_simulate, add_calibrate, add_map, add_localize, add_evaluate,
                         add_bench, add_convert, add_info})
    add(app, session);
  try {
    parse(app, arguments);
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
