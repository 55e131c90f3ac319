#include "map_occupancy.hpp"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording_info.hpp"
#include "mstsl/io/tum.hpp"

#include "drive_report.hpp"
#include "interrupt.hpp"
#include "output_paths.hpp"
#include "progress.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

/// When the logs begin and how long they last together.
struct Extent {
  Stamp first;
  double seconds = 0.0;
};

std::optional<Extent> extent_of(const std::vector<fs::path>& logs) {
  const auto first = io::describe_recording(logs.front()), last = io::describe_recording(logs.back());
  if (!first || !last || !first->first || !last->last) return std::nullopt;
  return Extent{*first->first, std::max(*last->last - *first->first, 1e-3)};
}

bool holds(const fs::path& log, const std::string& topic) {
  const auto info = io::describe_recording(log);
  return !info || std::any_of(info->topics.begin(), info->topics.end(),
                              [&](const io::TopicInfo& t) { return t.name == topic; });
}

/// Without a magnetometer a map is made from scans alone.
io::PlayOptions what_there_is(const OccupancyMapWish& wish) {
  io::PlayOptions play = wish.play;
  play.topics.imu.clear();
  play.topics.pose.clear();
  const auto lacks = [&](const std::string& topic) {
    return !std::all_of(wish.logs.begin(), wish.logs.end(),
                        [&](const fs::path& log) { return holds(log, topic); });
  };
  if (wish.without_field || lacks(play.topics.magnetic_field)) play.topics.magnetic_field.clear();
  return play;
}

template <typename Consumer>
void hand_over(Consumer& consumer, const SensorEvent& event) {
  std::visit(
      [&](const auto& reading) {
        if constexpr (requires { consumer.observe(reading); }) consumer.observe(reading);
      },
      event);
}

Result<io::PlayReport> play_all(const Session& session, const OccupancyMapWish& wish, const io::PlayOptions& play,
                                const char* what,
                                const std::function<void(const io::RecordingHeader&)>& on_header,
                                const std::function<void(const SensorEvent&)>& on_event) {
  Progress progress(what, session.quiet);
  const auto extent = extent_of(wish.logs);
  auto played = io::play(wish.logs, play, on_header, [&](const SensorEvent& event) {
    on_event(event);
    if (extent) progress.show((stamp_of(event) - extent->first) / extent->seconds);
    return !interrupted();
  });
  if (played && interrupted()) return Error("interrupted; nothing was written");
  return played;
}

/// Draws each scan from where the robot was when it was taken.
class Drawing {
 public:
  Drawing(const SlamTrack& track, const MappingOptions& options) : track_(track), mapper_(options) {}

  void set_rig(const Rig& rig) { rig_ = rig; }
  void observe(const LaserScan& scan) {
    constexpr double kLongestGap_s = 1.0;
    // A robot that stands sees the same again and again: a scan each second is enough of that.
    constexpr double kMoved_m = 0.05, kTurned_rad = 0.05, kStood_s = 1.0;
    const auto pose = track_.map_T_base.at(scan.stamp, kLongestGap_s);
    if (!pose || error_) return;
    if (last_ && distance(last_->pose, *pose) < kMoved_m &&
        std::abs(angle_between(last_->pose.yaw, pose->yaw)) < kTurned_rad && scan.stamp - last_->stamp < kStood_s)
      return;
    last_ = {scan.stamp, *pose};
    const auto end = track_.map_T_base.at(scan.stamp + sweep_duration_s(scan), kLongestGap_s);
    const auto drawn = mapper_.insert(scan, rig_.base_T_laser, *pose, between(*pose, end.value_or(*pose)));
    if (!drawn) error_ = drawn.error();
  }
  Result<OccupancyGrid> finish() const {
    if (error_) return *error_;
    return mapper_.grid();
  }

 private:
  const SlamTrack& track_;
  OccupancyMapper mapper_;
  Rig rig_;
  std::optional<TimedPose> last_;
  std::optional<Error> error_;
};

Result<void> write_tum(const Trajectory& trajectory, const fs::path& file) {
  auto writer = io::TumWriter::open(file);
  if (!writer) return writer.error();
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    if (auto written = writer->write({trajectory[i].stamp, trajectory[i].pose}); !written) return written.error();
  return writer->close();
}

}  // namespace

Result<MappedDrive> map_drive(const Session& session, const OccupancyMapWish& wish) {
  io::PlayOptions play = what_there_is(wish);
  std::optional<Slam> slam;
  SlamOptions options = wish.slam;
  options.loops.use_field = !play.topics.magnetic_field.empty();
  const auto played = play_all(
      session, wish, play, "finding the way",
      [&](const io::RecordingHeader& header) { slam.emplace(header.rig, options); },
      [&](const SensorEvent& event) { hand_over(*slam, event); });
  if (!played) return played.error();
  const std::string where = wish.logs.front().string() + (wish.logs.size() > 1 ? " and others" : "");
  if (!slam) return Error(where + ": the log is empty");
  Result<SlamTrack> track = slam->finish();
  if (!track) return track.error().within(where);
  MappedDrive drive{.grid = {}, .track = std::move(track).value(), .warnings = played->warnings};
  play.topics.magnetic_field.clear();
  play.topics.pose = wish.truth_topic;
  Drawing drawing(drive.track, wish.drawing);
  const auto drawn = play_all(
      session, wish, play, "drawing", [&](const io::RecordingHeader& header) { drawing.set_rig(header.rig); },
      [&](const SensorEvent& event) {
        hand_over(drawing, event);
        if (const auto* pose = std::get_if<PoseReading>(&event)) drive.truth.push_back(*pose);
      });
  if (!drawn) return drawn.error();
  Result<OccupancyGrid> grid = drawing.finish();
  if (!grid) return grid.error().within(where);
  if (count(*grid, CellState::kFree) == 0) return Error(where + ": no scan showed any free ground");
  drive.grid = std::move(grid).value();
  return drive;
}

Result<Exit> map_occupancy(const Session& session, const OccupancyMapWish& wish) {
  std::vector<fs::path> outputs{wish.output};
  for (const auto& file : {wish.tum, wish.report, wish.picture})
    if (file) outputs.push_back(*file);
  if (auto error = overwritten_input(outputs, wish.logs)) return *std::move(error);
  const Result<MappedDrive> drive = map_drive(session, wish);
  if (!drive) return drive.error();
  if (!session.quiet)
    for (const std::string& warning : drive->warnings) fmt::print(stderr, "mstsl: warning: {}\n", warning);
  if (const auto written = io::write_map(drive->grid, wish.output); !written) return written.error();
  if (wish.tum)
    if (const auto written = write_tum(drive->track.map_T_base, *wish.tum); !written) return written.error();
  if (session.json)
    fmt::print("{}\n", drive_report_json(*drive));
  else if (!session.quiet)
    fmt::print("{}written to {}\n", drive_report_text(*drive), wish.output.string());
  return Exit::kDone;
}

}  // namespace mstsl::app
