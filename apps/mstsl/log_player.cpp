#include "log_player.hpp"

#include "interrupt.hpp"
#include "log_span.hpp"
#include "progress.hpp"

namespace mstsl::app {

Result<io::PlayReport> play_logs(const Session& session, const std::vector<std::filesystem::path>& logs,
                                 const io::PlayOptions& play, const std::string& what,
                                 const std::function<void(const io::RecordingHeader&)>& on_header,
                                 const std::function<bool(const SensorEvent&)>& on_event) {
  Progress progress(what, session.quiet);
  const auto span = span_of(logs);
  auto played = io::play(logs, play, on_header, [&](const SensorEvent& event) {
    if (span) progress.show(span->share(stamp_of(event)));
    return on_event(event) && !interrupted();
  });
  if (played && interrupted()) return Error("interrupted; nothing was written");
  return played;
}

}  // namespace mstsl::app
