#include "log_player.hpp"

#include <algorithm>

#include "mstsl/io/recording_info.hpp"

#include "interrupt.hpp"
#include "progress.hpp"

namespace mstsl::app {

Result<io::PlayReport> play_logs(const Session& session, const std::vector<std::filesystem::path>& logs,
                                 const io::PlayOptions& play, const std::string& what,
                                 const std::function<void(const io::RecordingHeader&)>& on_header,
                                 const std::function<bool(const SensorEvent&)>& on_event) {
  Progress progress(what, session.quiet);
  const auto begin = io::describe_recording(logs.front()), end = io::describe_recording(logs.back());
  const bool known = begin && end && begin->first && end->last;
  const double seconds = known ? std::max(*end->last - *begin->first, 1e-3) : 1.0;
  auto played = io::play(logs, play, on_header, [&](const SensorEvent& event) {
    if (known) progress.show((stamp_of(event) - *begin->first) / seconds);
    return on_event(event) && !interrupted();
  });
  if (played && interrupted()) return Error("interrupted; nothing was written");
  return played;
}

}  // namespace mstsl::app
