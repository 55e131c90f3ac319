#include "bench_mapping.hpp"

#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "mstsl/io/atomic_file.hpp"

#include "build_hash.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace mstsl::app {

void add_mapping_options(CLI::App& command, MappingWish& wish) {
  const std::string group = "Protocol mapping";
  command.add_option("--robots", wish.robots, "good: a laser of 30 m; cheap: one of 8 m and worse wheels")
      ->delimiter(',')
      ->check(CLI::IsMember(mapping_robot_names()))
      ->capture_default_str()
      ->group(group);
  command.add_option("--way", wish.length_m, "Metres driven for a map")
      ->check(CLI::Range(20.0, 1e5))
      ->capture_default_str()
      ->group(group);
}

Result<Exit> bench_mapping(const Session& session, const MappingWish& wish,
                           const std::vector<std::string>& worlds, int runs,
                           const std::filesystem::path& folder) {
  MappingProtocolOptions options;
  if (!worlds.empty()) options.worlds = worlds;
  options.robots = wish.robots;
  options.length_m = wish.length_m;
  options.runs = runs;
  options.seed = session.seed;
  options.threads = session.threads;
  options.crew = session.crew;
  options.folder = folder;
  options.build = build_hash();
  Progress progress("mapping", session.quiet);
  options.progress = [&](double share) { return progress.show(share), !interrupted(); };
  const auto records = run_mapping_protocol(options);
  if (!records) return records.error();
  if (!session.crew.leads()) return Exit::kDone;
  const std::string text = mapping_text(*records), json = mapping_json(*records, options, MSTSL_COMMIT);
  for (const auto& [name, content] : {std::pair{"mapping.txt", &text}, std::pair{"mapping.json", &json}})
    if (const auto written = io::write_file(folder / name, *content); !written) return written.error();
  if (!session.quiet) fmt::print("{}", session.json ? json : text);
  return Exit::kDone;
}

}  // namespace mstsl::app
