#include "find_start.hpp"

#include "mstsl/localize/methods.hpp"

#include "log_player.hpp"

namespace mstsl::app {

Result<std::optional<FoundStart>> find_start(const Session& session,
                                             const std::vector<std::filesystem::path>& logs,
                                             const io::PlayOptions& play,
                                             const std::shared_ptr<const LocalizationMaps>& maps,
                                             const std::string& what) {
  MethodOptions options;
  options.threads = session.threads;
  const auto joint = make_method("joint", maps, options);
  if (!joint) return joint.error();
  std::optional<AnyLocalizer> localizer;
  std::optional<FoundStart> found;
  const auto played = play_logs(
      session, logs, play, what,
      [&](const io::RecordingHeader& header) { localizer.emplace((*joint)(header.rig)); },
      [&](const SensorEvent& event) {
        feed(*localizer, event);
        const Estimate estimate = localizer->estimate();
        if (estimate.map_T_base)
          found = {{estimate.stamp, *estimate.map_T_base, estimate.covariance}, estimate.travelled_m};
        return !found.has_value();
      });
  if (!played) return played.error();
  return found;
}

}  // namespace mstsl::app
