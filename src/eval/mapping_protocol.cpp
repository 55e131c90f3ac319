#include "mstsl/eval/mapping_protocol.hpp"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/sim/occupancy_map.hpp"

#include "mapping_drive.hpp"
#include "mapping_record.hpp"
#include "mapping_run.hpp"
#include "piece_store.hpp"
#include "piecework.hpp"

namespace mstsl {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kWorldStream = 1;

/// One drive of the protocol.
struct Drive {
  std::string world, robot;
  int run = 0;
  std::size_t place = 0;  ///< decides world, way and noise, whatever robot drives
  std::string name() const { return fmt::format("mapping {} {} {}", robot, world, run); }
};

std::vector<Drive> drives_of(const MappingProtocolOptions& options) {
  std::vector<Drive> drives;
  for (const std::string& robot : options.robots) {
    std::size_t place = 0;
    for (const std::string& world : options.worlds)
      for (int run = 0; run < options.runs; ++run) drives.push_back({world, robot, run, place++});
  }
  return drives;
}

/// Both ways of mapping it.
Result<std::string> mapped_both_ways(const Drive& drive, const MappingProtocolOptions& options) {
  const Random random = Random(options.seed).fork(drive.place);
  const auto world = sim::make_world(drive.world, {}, random.fork(kWorldStream));
  if (!world) return world.error();
  const auto recording = record_drive(*world, drive.robot, options, random);
  if (!recording) return recording.error().within(drive.world);
  const OccupancyGrid true_map = sim::occupancy_map(*world);
  Json records = Json::array();
  for (const bool with_field : {false, true}) {
    auto record = map_drive(*recording, true_map, with_field);
    if (!record) return record.error().within(drive.world);
    record->world = drive.world, record->robot = drive.robot, record->run = drive.run;
    records.push_back(json_of(*record));
  }
  return records.dump();
}

Result<std::vector<MappingRecord>> records_of(const std::vector<Drive>& drives, const PieceStore& store) {
  std::vector<MappingRecord> records;
  for (const Drive& drive : drives) {
    const std::string* line = store.find(drive.name());
    const Json both = line ? Json::parse(*line, nullptr, false) : Json();
    if (!both.is_array()) return Error(fmt::format("drive '{}' is missing", drive.name()));
    for (const Json& one : both) {
      auto record = mapping_record_from(one);
      if (!record) return record.error();
      records.push_back(std::move(record).value());
    }
  }
  return records;
}

}  // namespace

std::vector<std::string> mapping_robot_names() { return {"good", "cheap"}; }

Result<std::vector<MappingRecord>> run_mapping_protocol(const MappingProtocolOptions& options) {
  const std::string text = fmt::format("seed {} length_m {}", options.seed, options.length_m);
  auto store = PieceStore::open(options.folder, {text, options.build}, options.crew);
  if (!store) return store.error();
  const std::vector<Drive> drives = drives_of(options);
  std::vector<Drive> missing;
  for (const Drive& drive : drives)
    if (!store->find(drive.name())) missing.push_back(drive);
  const Portion mine = portion_of(missing.size(), options.crew);
  Piecework work(*store,
                 [&](const char*, double share) { return !options.progress || options.progress(share); });
  work.expect(mine.last - mine.first);
  parallel_for(mine.last - mine.first, options.threads, [&](std::size_t i) {
    if (work.stopped()) return;
    const Drive& drive = missing[mine.first + i];
    const Result<std::string> both = mapped_both_ways(drive, options);
    if (!both) return work.fail(both.error());
    work.finish({{drive.name(), *both}});
  });
  if (const Result<void> all = store->gather(options.crew, work.end()); !all) return all.error();
  return records_of(drives, *store);
}

}  // namespace mstsl
