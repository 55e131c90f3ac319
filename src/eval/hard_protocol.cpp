#include "mstsl/eval/hard_protocol.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hard_run.hpp"
#include "hard_site.hpp"
#include "piece_store.hpp"
#include "piecework.hpp"

namespace mstsl {
namespace {

/// One start, and the methods that have not heard it yet.
struct Task {
  Disturbance disturbance;
  int run = 0;
  std::vector<std::string> missing;
};

/// The tasks that share a building and its maps.
struct Group {
  std::string world;
  int building = 0;
  SurveyKind kind;
  std::vector<Task> tasks;
};

std::string piece_name(const HardKey& key) {
  return fmt::format("{} {} {} {} {}", key.set, key.world, key.disturbance, key.method, key.run);
}

std::vector<Group> groups_of(const HardProtocolOptions& options, const PieceStore& store) {
  std::vector<Group> groups;
  const auto group_for = [&](const std::string& world, int building, const SurveyKind& kind) -> Group& {
    for (Group& group : groups)
      if (group.world == world && group.building == building && group.kind == kind) return group;
    return groups.emplace_back(Group{world, building, kind, {}});
  };
  for (const std::string& world : options.worlds)
    for (const std::string& name : options.disturbances)
      for (int run = 0; run < options.runs; ++run) {
        Task task{*disturbance_by(name), run, {}};
        for (const std::string& method : options.methods)
          if (!store.find(piece_name(key_of(options, world, name, method, run))))
            task.missing.push_back(method);
        if (!task.missing.empty())
          group_for(world, run % options.buildings, survey_kind(task.disturbance)).tasks.push_back(task);
      }
  return groups;
}

std::size_t count_tasks(const std::vector<Group>& groups) {
  std::size_t tasks = 0;
  for (const Group& group : groups) tasks += group.tasks.size();
  return tasks;
}

/// What is this process's of them. Neighbours share a building, so that few maps are made twice.
std::vector<Group> portion_of(const std::vector<Group>& groups, const Crew& crew) {
  const Portion portion = portion_of(count_tasks(groups), crew);
  std::vector<Group> mine;
  std::size_t at = 0;
  for (const Group& group : groups) {
    Group part{group.world, group.building, group.kind, {}};
    for (const Task& task : group.tasks)
      if (const std::size_t i = at++; i >= portion.first && i < portion.last) part.tasks.push_back(task);
    if (!part.tasks.empty()) mine.push_back(std::move(part));
  }
  return mine;
}

std::optional<Error> wrong_with(const HardProtocolOptions& options) {
  const auto unknown = [](const auto& wanted, const auto& known) -> const std::string* {
    for (const std::string& name : wanted)
      if (std::find(known.begin(), known.end(), name) == known.end()) return &name;
    return nullptr;
  };
  const auto error = [](const char* what, const std::string& name, const auto& known) {
    return Error(fmt::format("there is no {} '{}'; choose of {}", what, name, fmt::join(known, ", ")));
  };
  if (const auto* name = unknown(options.methods, method_names()))
    return error("method", *name, method_names());
  if (const auto* name = unknown(options.worlds, sim::world_names()))
    return error("world", *name, sim::world_names());
  if (const auto* name = unknown(options.disturbances, disturbance_names()))
    return error("disturbance", *name, disturbance_names());
  if (options.runs < 1 || options.buildings < 1 || options.beams < 2 || !(options.length_m > 0) ||
      !(options.scan_rate_hz > 0))
    return Error(
        "the hard protocol needs at least one run, one building, two beams, and a length and a scan "
        "rate above 0");
  return std::nullopt;
}

void run_group(const Group& group, const HardProtocolOptions& options, Piecework& work) {
  work.tell("survey and map", work.share());
  const Result<HardSite> site = make_site(options, group.world, group.building, group.kind);
  if (!site) return work.fail(site.error());
  parallel_for(group.tasks.size(), options.threads, [&](std::size_t i) {
    if (work.stopped()) return;
    const Task& task = group.tasks[i];
    std::vector<LocalizerFactory> missing;
    for (const std::string& name : task.missing)
      for (std::size_t m = 0; m < options.methods.size(); ++m)
        if (options.methods[m] == name) missing.push_back(site->methods[m]);
    auto drive = drive_hard_run(site->building, missing, task.disturbance, options,
                                site->runs.fork(static_cast<std::uint64_t>(task.run)));
    if (!drive) return work.fail(drive.error());
    std::vector<std::pair<std::string, std::string>> finished;
    for (std::size_t m = 0; m < drive->records.size(); ++m) {
      HardRecord& record = drive->records[m];
      record.key = key_of(options, group.world, task.disturbance.name, task.missing[m], task.run);
      record.options = text_of(options);
      finished.emplace_back(piece_name(record.key), to_line(record));
    }
    work.finish(finished);
  });
}

/// The records of all runs asked for, in order.
Result<std::vector<HardRecord>> records_of(const HardProtocolOptions& options, const PieceStore& store) {
  std::vector<HardRecord> records;
  for (const std::string& world : options.worlds)
    for (const std::string& disturbance : options.disturbances)
      for (int run = 0; run < options.runs; ++run)
        for (const std::string& method : options.methods) {
          const std::string name = piece_name(key_of(options, world, disturbance, method, run));
          const std::string* line = store.find(name);
          Result<HardRecord> record = line ? record_from_line(*line) : Error("it is missing");
          if (!record) return record.error().within(fmt::format("run '{}'", name));
          records.push_back(std::move(record).value());
        }
  return records;
}

}  // namespace

std::string_view to_string(CaseSet set) {
  return set == CaseSet::kFix ? "fix" : set == CaseSet::kKidnap ? "kidnap" : "long";
}

std::vector<std::string> hard_world_names() {
  return {"symmetric-loop", "aisles", "pillar-hall", "h-wing", "office"};
}

Result<std::vector<HardRecord>> run_hard_protocol(const HardProtocolOptions& options) {
  if (auto error = wrong_with(options)) return *error;
  Result<PieceStore> store =
      PieceStore::open(options.folder, {text_of(options), options.build}, options.crew);
  if (!store) return store.error();
  const std::vector<Group> groups = portion_of(groups_of(options, *store), options.crew);
  Piecework work(*store, options.progress);
  work.expect(count_tasks(groups));
  for (const Group& group : groups)
    if (!work.stopped()) run_group(group, options, work);
  if (const Result<void> end = store->gather(options.crew, work.end()); !end) return end.error();
  return records_of(options, *store);
}

}  // namespace mstsl
