#include "survey_positions.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "interrupt.hpp"
#include "log_player.hpp"

namespace mstsl::app {

Result<Pose2> pose_from(const std::string& text) {
  std::array<double, 3> numbers{};
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  char comma = ',';
  for (std::size_t i = 0; i < numbers.size() && comma == ','; ++i) {
    in >> numbers[i];
    if (i + 1 < numbers.size()) in >> comma;
  }
  const bool whole = !in.fail() && comma == ',' && (in >> std::ws).eof();
  if (!whole || !std::isfinite(numbers[0] + numbers[1] + numbers[2]))
    return Error(fmt::format("'{}' is no pose; give X,Y,YAW in m and rad, as in 1.5,-2,3.14", text));
  return Pose2::from({numbers[0], numbers[1]}, numbers[2]);
}

Result<SurveyTrack> track_survey(const std::filesystem::path& log, const io::PlayOptions& play,
                                 const KnownStart& start, const std::function<void(Stamp)>& at) {
  io::PlayOptions wanted = play;
  wanted.topics.magnetic_field.clear();
  wanted.topics.pose.clear();
  std::optional<SurveyTracker> tracker;
  const auto played = io::play(
      {log}, wanted,
      [&](const io::RecordingHeader& header) { tracker.emplace(start.walls, header.rig, start.map_T_base); },
      [&](const SensorEvent& event) {
        if (!start.stamp || stamp_of(event) >= *start.stamp) hand_over(*tracker, event);
        at(stamp_of(event));
        return !interrupted();
      });
  if (!played) return played.error();
  if (interrupted()) return Error("interrupted; nothing was written");
  if (!tracker) return Error(log.string() + ": the log is empty");
  Result<SurveyTrack> track = tracker->finish();
  if (!track) return track.error().within(log.string());
  return track;
}

}  // namespace mstsl::app
