#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording_writer.hpp"
#include "mstsl/io/truth.hpp"

#include "../localize/hand_made_world.hpp"

namespace mstsl::test {

/// The hand-made building's files and one drive through it, made once for all tests.
class Site {
 public:
  static const Site& get() {
    static const Site site;
    return site;
  }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  void write_log(const std::string& name, const std::vector<SensorEvent>& events) const {
    auto writer = must(io::RecordingWriter::open(path(name), Rig{}, {}));
    for (const SensorEvent& event : events) must(writer.write(event));
    must(writer.close());
  }

  const std::vector<SensorEvent>& events() const { return events_; }

  /// `mstsl localize` of one of the site's logs, by its options.
  std::string localize(const std::string& log, const std::string& output,
                       const std::string& more = "") const {
    return "localize --map " + path("map.yaml").string() + " --field " + path("field.nc").string() + " -o " +
           path(output).string() + " " + more + " " + path(log).string();
  }

 private:
  Site() {
    const HandMadeWorld world;
    must(io::write_map(world.map, path("map.yaml")));
    must(io::write_field_map(world.field_map(), path("field.nc")));
    must(io::write_field_map(HandMadeWorld(Pose2{13.0, 4.0, 0.3}).field_map(), path("elsewhere.nc")));
    const Drive drive{{3.0, 1.0, radians(30)}, radians(-30), 0.0, 8.0};
    events_ = events_of(world, drive, Rig{});
    write_log("run.mcap", events_);
    write_log("short.mcap", {events_.begin(), events_.begin() + 60});
    write_log("empty.mcap", {});
    std::vector<PoseReading> truth;
    const Trajectory poses = driven(drive);
    for (std::size_t i = 0; i < poses.size(); ++i) truth.push_back({poses[i].stamp, poses[i].pose});
    must(io::write_truth(truth, path("truth.csv")));
  }

  TemporaryFolder folder_;
  std::vector<SensorEvent> events_;
};

}  // namespace mstsl::test
