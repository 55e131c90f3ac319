#include "mstsl/eval/hard_trace.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

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
  std::vector<RunTrace> traces;
  std::string made;  // which site stands ready
  std::optional<HardSite> site;
  std::shared_ptr<const TracedPlace> place;
  for (const HardStart& start : starts) {
    const auto disturbance = disturbance_by(start.disturbance);
    if (!disturbance) return Error(fmt::format("there is no disturbance '{}'", start.disturbance));
    const SurveyKind kind = survey_kind(*disturbance);
    const int building = start.run % options.buildings;
    const std::string name = fmt::format("{} {}, {}", start.world, building, kind.name());
    if (std::exchange(made, name) != name) {
      Result<HardSite> next = make_site(options, start.world, building, kind);
      if (!next) return next.error();
      site.emplace(std::move(next).value());
      auto shown = place_of(*site, name);
      if (!shown) return shown.error();
      place = std::move(shown).value();
    }
    auto drive = drive_hard_run(site->building, site->methods, *disturbance, options,
                                site->runs.fork(static_cast<std::uint64_t>(start.run)), Traced::kYes);
    if (!drive) return drive.error();
    RunTrace& trace = traces.emplace_back(std::move(drive->trace));
    trace.name = fmt::format("{}, {}, run {}", start.world, start.disturbance, start.run);
    trace.place = place;
    for (std::size_t m = 0; m < trace.methods.size(); ++m) trace.methods[m].name = options.methods[m];
    if (options.progress &&
        !options.progress("replays", static_cast<double>(traces.size()) / static_cast<double>(starts.size())))
      return Error("interrupted; the same command goes on from there");
  }
  return traces;
}

}  // namespace mstsl
