#include "mstsl/eval/hard_trace.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "mstsl/core/parallel.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/sim/occupancy_map.hpp"

#include "hard_run.hpp"
#include "hard_site.hpp"

namespace mstsl {
namespace {

HardStart start_of(const HardRecord& record) {
  return {record.key.world, record.key.disturbance, record.key.run};
}

bool went_wrong(const HardRecord& record) {
  return !record.succeeded() || record.wrong_at_99 > 0 || record.false_alarms > 0;
}

void add(std::vector<HardStart>& starts, HardStart start, std::size_t most) {
  if (starts.size() < most && std::ranges::find(starts, start) == starts.end())
    starts.push_back(std::move(start));
}

Result<std::shared_ptr<const TracedPlace>> place_of(const HardSite& site, const std::string& name) {
  Result<FieldMap> field = io::read_field_map(site.field);
  if (!field) return field.error();
  return std::make_shared<const TracedPlace>(
      TracedPlace{name, sim::occupancy_map(site.building.surveyed), std::move(field).value()});
}

/// Starts in one building with one survey, which are made once for all of them.
struct SiteStarts {
  std::string world;
  int building = 0;
  SurveyKind kind;
  std::vector<std::size_t> starts;  ///< which
  std::string name() const { return fmt::format("{} {}, {}", world, building, kind.name()); }
};

Result<std::vector<SiteStarts>> by_site(const std::vector<HardStart>& starts, int buildings) {
  std::vector<SiteStarts> sites;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto disturbance = disturbance_by(starts[i].disturbance);
    if (!disturbance) return Error(fmt::format("there is no disturbance '{}'", starts[i].disturbance));
    SiteStarts site{starts[i].world, starts[i].run % buildings, survey_kind(*disturbance), {}};
    const auto same = std::ranges::find(sites, site.name(), &SiteStarts::name);
    (same == sites.end() ? sites.emplace_back(std::move(site)) : *same).starts.push_back(i);
  }
  return sites;
}

Result<RunTrace> trace_of(const HardProtocolOptions& options, const HardSite& site,
                          const std::shared_ptr<const TracedPlace>& place, const HardStart& start) {
  auto drive = drive_hard_run(site.building, site.methods, *disturbance_by(start.disturbance), options,
                              site.runs.fork(static_cast<std::uint64_t>(start.run)), Traced::kYes);
  if (!drive) return drive.error();
  RunTrace trace = std::move(drive->trace);
  trace.name = fmt::format("{}, {}, run {}", start.world, start.disturbance, start.run);
  trace.place = place;
  for (std::size_t m = 0; m < trace.methods.size(); ++m) trace.methods[m].name = options.methods[m];
  return trace;
}

}  // namespace

std::vector<HardStart> worth_looking_at(const std::vector<HardRecord>& records,
                                        const std::vector<std::string>& methods, std::size_t most) {
  std::vector<HardStart> starts;
  for (const HardRecord& record : records) {
    // Records come in the order world, disturbance, run: the last disturbance is that of the world's last
    // record.
    const auto last = std::find_if(records.rbegin(), records.rend(),
                                   [&](const HardRecord& r) { return r.key.world == record.key.world; });
    if (record.key.run == 0 && record.key.disturbance == last->key.disturbance)
      add(starts, start_of(record), most);
  }
  for (const std::string& method : methods)
    for (const HardRecord& record : records)
      if (record.key.method == method && went_wrong(record)) add(starts, start_of(record), most);
  return starts;
}

Result<std::vector<RunTrace>> trace_hard_runs(const HardProtocolOptions& options,
                                              const std::vector<HardStart>& starts) {
  const Result<std::vector<SiteStarts>> sites = by_site(starts, options.buildings);
  if (!sites) return sites.error();
  std::vector<std::optional<Result<RunTrace>>> traced(starts.size());
  std::mutex mutex;
  std::size_t done = 0;
  bool ended = false;
  for (const SiteStarts& at : *sites) {
    const Result<HardSite> site = make_site(options, at.world, at.building, at.kind);
    if (!site) return site.error();
    const auto place = place_of(*site, at.name());
    if (!place) return place.error();
    parallel_for(at.starts.size(), options.threads, [&](std::size_t i) {
      {
        const std::lock_guard lock(mutex);
        if (ended) return;
      }
      traced[at.starts[i]] = trace_of(options, *site, *place, starts[at.starts[i]]);
      const std::lock_guard lock(mutex);
      ++done;
      if (options.progress)
        ended |= !options.progress("replays", static_cast<double>(done) / static_cast<double>(starts.size()));
    });
    if (ended) return Error("interrupted; the same command goes on from there");
  }
  std::vector<RunTrace> traces;
  for (auto& trace : traced) {
    if (!*trace) return trace->error();
    traces.push_back(std::move(*trace).value());
  }
  return traces;
}

}  // namespace mstsl
