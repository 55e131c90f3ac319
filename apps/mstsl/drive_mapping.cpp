#include "drive_mapping.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "mstsl/io/recording_info.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/mapping/restart_watch.hpp"
#include "mstsl/mapping/track_drawer.hpp"

#include "find_start.hpp"
#include "log_player.hpp"
#include "survey_reader.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;
using Logs = std::vector<fs::path>;

std::string name_of(const Logs& logs) {
  return logs.front().string() + (logs.size() > 1 ? " and others" : "");
}

std::vector<Logs> drives_of(const DrivesWish& wish) {
  if (wish.continuous) return {wish.logs};
  std::vector<Logs> drives;
  for (const fs::path& log : wish.logs) drives.push_back({log});
  return drives;
}

enum class Reading { kOdometry, kField, kPose };

bool all_hold(const Logs& logs, Reading kind, const std::string& topic) {
  return std::all_of(logs.begin(), logs.end(), [&](const fs::path& log) {
    const auto info = io::describe_recording(log);
    if (!info) return true;  // complained of when it is played
    // A CARMEN log has no topics; it holds scans, odometry and, if it was corrected, poses.
    if (info->format == "CARMEN log") return kind != Reading::kField;
    return std::any_of(info->topics.begin(), info->topics.end(),
                       [&](const io::TopicInfo& t) { return t.name == topic && t.messages > 0; });
  });
}

/// What of a map is to be doubted, a sentence each.
std::vector<std::string> doubts(const SlamTrack& track) {
  std::vector<std::string> sentences;
  const auto standing = std::count_if(track.closures.begin(), track.closures.end(),
                                      [](const Closure& c) { return !c.refuted; });
  constexpr double kLongWithoutLoop_m = 60.0, kPoorScore = 0.6;
  if (standing == 0 && track.way_m() > kLongWithoutLoop_m)
    sentences.push_back(
        fmt::format("no loop was closed in {:.0f} m: the map is no better than scans matched one to the "
                    "next, which may bend it; let the robot come back to where it was",
                    track.way_m()));
  if (track.mean_score < kPoorScore)
    sentences.push_back(
        fmt::format("a scan fits those before it to {:.0f} % only; check the laser's mounting, and that "
                    "scans and odometry have one clock",
                    100 * track.mean_score));
  return sentences;
}

class DriveMapper {
 public:
  DriveMapper(const Session& session, const DrivesWish& wish)
      : session_(session), wish_(wish), drives_(drives_of(wish)), slam_(options_of(wish)) {
    play_ = wish.play;
    play_.topics.imu.clear();
    play_.topics.pose.clear();
    if (wish.without_field || !all_hold(wish.logs, Reading::kField, play_.topics.magnetic_field))
      play_.topics.magnetic_field.clear();
    if (!all_hold(wish.logs, Reading::kOdometry, play_.topics.odometry)) {
      warnings_.push_back(
          fmt::format("there is no odometry under {}: the way is found by scans alone, which cannot "
                      "tell how far the robot goes along a bare corridor",
                      play_.topics.odometry));
      play_.topics.odometry.clear();
    }
  }

  Result<MappedDrives> map() {
    if (drives_.size() > 1 && play_.topics.magnetic_field.empty())
      return Error(
          "drives are joined by their magnetic field, and not all logs have it; map them one by one, or give "
          "--continuous if each log begins where the one before ended");
    if (auto error = truth_is_missing()) return *std::move(error);
    for (std::size_t k = 0; k < drives_.size(); ++k)
      if (const auto error = add_drive(k)) return *error;
    MappedDrives mapped{.grid = {}, .track = *track_, .play = play_, .warnings = {}, .truth = {}};
    Result<OccupancyGrid> grid = draw(drives_.size(), {.map = wish_.drawing}, &mapped.truth);
    if (!grid) return grid.error();
    if (count(*grid, CellState::kFree) == 0)
      return Error(name_of(wish_.logs) + ": no scan showed any free ground");
    mapped.grid = std::move(grid).value();
    for (std::string& doubt : doubts(*track_)) warnings_.push_back(std::move(doubt));
    mapped.warnings = std::move(warnings_);
    return mapped;
  }

 private:
  /// Said before the work, not after it.
  std::optional<Error> truth_is_missing() const {
    for (const fs::path& log : wish_.truth_topic.empty() ? Logs{} : wish_.logs)
      if (!all_hold({log}, Reading::kPose, wish_.truth_topic))
        return Error(
            fmt::format("{}: there is no pose under {} to hold the map against; `mstsl info` lists "
                        "what the log has",
                        log.string(), wish_.truth_topic));
    return std::nullopt;
  }

  SlamOptions options_of(const DrivesWish& wish) const {
    SlamOptions options = wish.slam;
    options.loops.use_field = !wish.without_field;
    options.without_wheels = !all_hold(wish.logs, Reading::kOdometry, wish.play.topics.odometry);
    return options;
  }

  std::string step(const char* what, std::size_t k) const {
    return drives_.size() == 1 ? what : fmt::format("{}, drive {} of {}", what, k + 1, drives_.size());
  }

  std::optional<Error> add_drive(std::size_t k) {
    std::optional<Anchor> anchor;
    if (k > 0) {
      Result<Anchor> found = locate(k);
      if (!found) return found.error();
      anchor = *found;
    }
    bool begun = false;
    RestartWatch watch;
    const auto played = play_logs(
        session_, drives_[k], play_, step("finding the way", k),
        [&](const io::RecordingHeader& header) { slam_.begin_drive(header.rig, anchor), begun = true; },
        [&](const SensorEvent& event) {
          hand_over(slam_, event);
          hand_over(watch, event);
          return true;
        });
    if (!played) return played.error();
    for (const std::string& warning : played->warnings) warnings_.push_back(warning);
    for (const RestartWatch::Jump& jump : watch.jumps())
      warnings_.push_back(fmt::format(
          "at {:.1f} s, where odometry begins anew, the field is another by {:.0f} uT: was the robot "
          "moved meanwhile? Then the map is wrong from there on; logs that do not begin where the one "
          "before ended are mapped without --continuous",
          jump.stamp.seconds(), jump.change_uT));
    if (!begun) return Error(name_of(drives_[k]) + ": the log is empty");
    Result<SlamTrack> track = slam_.track();
    if (!track) return track.error().within(name_of(drives_[k]));
    track_ = std::move(track).value();
    return std::nullopt;
  }

  /// The map of the first drives so far; and what the truth's topic says, if asked for.
  Result<OccupancyGrid> draw(std::size_t drives, const TrackDrawerOptions& options,
                             std::vector<std::vector<PoseReading>>* truth) {
    io::PlayOptions play = play_;
    play.topics.magnetic_field.clear();
    play.topics.odometry.clear();
    if (truth != nullptr) play.topics.pose = wish_.truth_topic;
    TrackDrawer drawer(options);
    for (std::size_t k = 0; k < drives; ++k) {
      if (truth != nullptr) truth->emplace_back();
      const auto played = play_logs(
          session_, drives_[k], play, step("drawing", k),
          [&](const io::RecordingHeader& header) {
            drawer.begin_drive(header.rig, track_->drives[k].map_T_base);
          },
          [&](const SensorEvent& event) {
            hand_over(drawer, event);
            if (const auto* pose = std::get_if<PoseReading>(&event); pose != nullptr && truth != nullptr)
              truth->back().push_back(*pose);
            return true;
          });
      if (!played) return played.error();
    }
    Result<OccupancyGrid> grid = drawer.grid();
    if (!grid) return grid.error().within(name_of(wish_.logs));
    return grid;
  }

  /// Where drive k was at some time, on the map of those before it: the joint method drives along until it is
  /// sure.
  Result<Anchor> locate(std::size_t k) {
    // Enough to find a place in.
    Result<OccupancyGrid> grid = draw(k, {.map = wish_.drawing, .every_m = 0.5, .every_rad = 0.5}, nullptr);
    if (!grid) return grid.error();
    Logs logs;
    std::vector<Trajectory> tracks;
    for (std::size_t i = 0; i < k; ++i)
      logs.push_back(drives_[i].front()), tracks.push_back(track_->drives[i].map_T_base);
    const auto survey = collect_fingerprints(session_, logs, play_, tracks);
    if (!survey) return survey.error();
    FieldMapOptions options{.resolution_m = 0.1};
    options.threads = session_.threads;
    Result<FieldMap> field = build_field_map(survey->fingerprints, &*grid, options);
    if (!field) return field.error().within(name_of(logs));
    auto maps = make_localization_maps(std::move(grid).value(), std::move(field).value(),
                                       {.threads = session_.threads});
    if (!maps) return maps.error().within(name_of(logs));
    const auto found = find_start(session_, drives_[k], play_, *maps, step("finding the start", k));
    if (!found) return found.error();
    if (!*found)
      return Error(
          fmt::format("{}: the drive could not be found in the map of those before it; does it go where they "
                      "went? Give --continuous if it begins where the last one ended",
                      name_of(drives_[k])));
    return (*found)->anchor;
  }

  const Session& session_;
  const DrivesWish& wish_;
  std::vector<Logs> drives_;
  io::PlayOptions play_;
  Slam slam_;
  std::optional<SlamTrack> track_;
  std::vector<std::string> warnings_;
};

}  // namespace

Result<MappedDrives> map_drives(const Session& session, const DrivesWish& wish) {
  return DriveMapper(session, wish).map();
}

}  // namespace mstsl::app
