#include "survey_reader.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "mstsl/io/recording_info.hpp"

#include "interrupt.hpp"
#include "progress.hpp"

namespace mstsl::app {
namespace {

/// When a log begins and how long it lasts, for the progress bar; nothing where it does not say.
std::optional<std::pair<Stamp, double>> extent(const std::filesystem::path& log) {
  const auto info = io::describe_recording(log);
  if (!info || !info->first || !info->last) return std::nullopt;
  return std::pair{*info->first, std::max(*info->last - *info->first, 1e-3)};
}

}  // namespace

Result<SurveyLogs> read_survey(const Session& session, const std::vector<std::filesystem::path>& logs,
                               const io::PlayOptions& play) {
  SurveyLogs survey;
  std::optional<FingerprintCollector> collector;
  Progress progress("reading", session.quiet);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto span = extent(logs[k]);
    const auto on_header = [&](const io::RecordingHeader& header) {
      survey.magnetometer_height_m = header.rig.base_T_magnetometer.translation().z();
      if (collector)
        collector->start_session(header.rig);
      else
        collector.emplace(header.rig);
    };
    const auto on_event = [&](const SensorEvent& event) {
      if (const auto* pose = std::get_if<PoseReading>(&event)) collector->observe(*pose);
      if (const auto* field = std::get_if<FieldReading>(&event)) collector->observe(*field);
      const double share = span ? std::clamp((stamp_of(event) - span->first) / span->second, 0.0, 1.0) : 0.5;
      progress.show((static_cast<double>(k) + share) / static_cast<double>(logs.size()));
      return !interrupted();
    };
    const Result<io::PlayReport> played = io::play({logs[k]}, play, on_header, on_event);
    if (!played) return played.error();
    if (interrupted()) return Error("interrupted; nothing was written");
    for (const auto& [what, count] : played->problems) survey.problems[what] += count;
    for (const std::string& warning : played->warnings) survey.warnings.push_back(warning);
  }
  if (!collector) return survey;
  survey.fingerprints = collector->finish();
  survey.collected = collector->report();
  return survey;
}

}  // namespace mstsl::app
