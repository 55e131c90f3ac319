#include "survey_reader.hpp"

#include <utility>
#include <variant>

#include "interrupt.hpp"
#include "log_span.hpp"
#include "progress.hpp"

namespace mstsl::app {
namespace {

/// Hands a collector a log's readings, and the poses of a track between them if there is one.
class Collecting {
 public:
  Collecting(FingerprintCollector& collector, const Trajectory* track)
      : collector_(collector), track_(track) {}

  void observe(const SensorEvent& event) {
    if (const auto* pose = std::get_if<PoseReading>(&event); pose && track_ == nullptr)
      collector_.observe(*pose);
    if (const auto* field = std::get_if<FieldReading>(&event)) {
      poses_until(field->stamp);
      collector_.observe(*field);
    }
  }
  void end() {
    if (track_ != nullptr && !track_->empty()) poses_until(track_->back().stamp);
  }

 private:
  void poses_until(Stamp stamp) {
    if (track_ == nullptr) return;
    for (; next_ < track_->size() && (*track_)[next_].stamp <= stamp; ++next_)
      collector_.observe(PoseReading{(*track_)[next_].stamp, (*track_)[next_].pose});
  }

  FingerprintCollector& collector_;
  const Trajectory* track_;
  std::size_t next_ = 0;
};

}  // namespace

Result<SurveyLogs> collect_fingerprints(const Session& session,
                                        const std::vector<std::filesystem::path>& logs,
                                        const io::PlayOptions& play,
                                        const std::vector<Trajectory>& map_T_base) {
  SurveyLogs survey;
  std::optional<FingerprintCollector> collector;
  Progress progress("reading the field", session.quiet);
  io::PlayOptions field_and_poses = play;
  field_and_poses.topics.scan.clear();
  field_and_poses.topics.odometry.clear();
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto span = span_of({logs[k]});
    std::optional<Collecting> collecting;
    const auto on_header = [&](const io::RecordingHeader& header) {
      survey.magnetometer_height_m = header.rig.base_T_magnetometer.translation().z();
      if (collector)
        collector->start_session(header.rig);
      else
        collector.emplace(header.rig);
      collecting.emplace(*collector, map_T_base.empty() ? nullptr : &map_T_base[k]);
    };
    const auto on_event = [&](const SensorEvent& event) {
      collecting->observe(event);
      const double share = span ? span->share(stamp_of(event)) : 0.5;
      progress.show((static_cast<double>(k) + share) / static_cast<double>(logs.size()));
      return !interrupted();
    };
    const Result<io::PlayReport> played = io::play({logs[k]}, field_and_poses, on_header, on_event);
    if (!played) return played.error();
    if (interrupted()) return Error("interrupted; nothing was written");
    if (collecting) collecting->end();
    survey.drives.push_back(
        {logs[k].filename().string(), span ? span->begin : Stamp{}, span ? span->end() : Stamp{}});
    for (const auto& [what, count] : played->problems) survey.problems[what] += count;
    for (const std::string& warning : played->warnings) survey.warnings.push_back(warning);
  }
  if (!collector) return survey;
  survey.fingerprints = collector->finish();
  survey.collected = collector->report();
  return survey;
}

Result<SurveyLogs> read_survey(const Session& session, const std::vector<std::filesystem::path>& logs,
                               const io::PlayOptions& play, const std::vector<KnownStart>& starts) {
  if (starts.empty()) return collect_fingerprints(session, logs, play);
  std::vector<SurveyTrack> tracks;
  std::vector<Trajectory> trajectories;
  {
    Progress progress("tracking", session.quiet);
    for (std::size_t k = 0; k < logs.size(); ++k) {
      const auto span = span_of({logs[k]});
      Result<SurveyTrack> track = track_survey(logs[k], play, starts[k], [&](Stamp at) {
        const double share = span ? span->share(at) : 0.5;
        progress.show((static_cast<double>(k) + share) / static_cast<double>(logs.size()));
      });
      if (!track) return track.error();
      trajectories.push_back(track->map_T_base);
      tracks.push_back(std::move(track).value());
    }
  }
  Result<SurveyLogs> survey = collect_fingerprints(session, logs, play, trajectories);
  if (survey) survey->tracks = std::move(tracks);
  return survey;
}

}  // namespace mstsl::app
