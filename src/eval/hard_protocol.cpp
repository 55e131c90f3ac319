#include "mstsl/eval/hard_protocol.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hard_run.hpp"
#include "hard_site.hpp"
#include "hard_store.hpp"

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

std::vector<Group> groups_of(const HardProtocolOptions& options, const HardStore& store) {
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
          if (!store.find(key_of(options, world, name, method, run))) task.missing.push_back(method);
        if (!task.missing.empty())
          group_for(world, run % options.buildings, survey_kind(task.disturbance)).tasks.push_back(task);
      }
  return groups;
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

/// Tells of progress, counts what is done, keeps records: from any thread.
class Work {
 public:
  Work(const HardProtocolOptions& options, HardStore& store, std::size_t tasks)
      : options_(options), store_(store), tasks_(tasks) {}

  void tell(const char* what) {
    const std::scoped_lock lock(mutex_);
    if (options_.progress && !options_.progress(what, share())) stopped_ = true;
  }
  void finish(std::vector<HardRecord> records) {
    {
      const std::scoped_lock lock(mutex_);
      for (HardRecord& record : records) store_.add(std::move(record));
      ++done_;
    }
    tell("runs");
  }
  void fail(Error error) {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = std::move(error);
    stopped_ = true;
  }
  bool stopped() const { return stopped_; }
  Result<void> end() const {
    if (error_) return *error_;
    if (!store_.good())
      return Error(options_.folder.string() + ": runs cannot be written; is the disk full?");
    if (stopped_)
      return Error(fmt::format("interrupted after {} of {} starts; the same command goes on from there",
                               done_, tasks_));
    return {};
  }

 private:
  double share() const { return static_cast<double>(done_) / static_cast<double>(tasks_); }
  const HardProtocolOptions& options_;
  HardStore& store_;
  std::size_t tasks_, done_ = 0;
  std::mutex mutex_;
  std::atomic<bool> stopped_ = false;
  std::optional<Error> error_;
};

void run_group(const Group& group, const HardProtocolOptions& options, Work& work) {
  work.tell("survey and map");
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
    for (std::size_t m = 0; m < drive->records.size(); ++m)
      drive->records[m].key = key_of(options, group.world, task.disturbance.name, task.missing[m], task.run);
    work.finish(std::move(drive->records));
  });
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
  Result<HardStore> store = HardStore::open(options.folder, text_of(options), options.build);
  if (!store) return store.error();
  const std::vector<Group> groups = groups_of(options, *store);
  std::size_t tasks = 0;
  for (const Group& group : groups) tasks += group.tasks.size();
  Work work(options, *store, tasks);
  for (const Group& group : groups)
    if (!work.stopped()) run_group(group, options, work);
  if (const Result<void> end = work.end(); !end) return end.error();

  std::vector<HardRecord> records;
  for (const std::string& world : options.worlds)
    for (const std::string& disturbance : options.disturbances)
      for (int run = 0; run < options.runs; ++run)
        for (const std::string& method : options.methods)
          if (const HardRecord* record = store->find(key_of(options, world, disturbance, method, run)))
            records.push_back(*record);
  return records;
}

}  // namespace mstsl
