#include "find_start.hpp"

#include <variant>

#include "mstsl/localize/methods.hpp"

#include "log_player.hpp"

namespace mstsl::app {
namespace {

/// The first pose of those that have been held since without a break.
class Holding {
 public:
  void observe(const Estimate& estimate) {
    if (!estimate.map_T_base) {
      start_.reset();
      return;
    }
    const double driven_m = estimate.travelled_m - last_m_;
    const bool jumped = start_ && distance(last_, *estimate.map_T_base) > driven_m + kJump_m;
    if (!start_ || jumped)
      start_ = {{estimate.stamp, *estimate.map_T_base, estimate.covariance}, estimate.travelled_m};
    last_ = *estimate.map_T_base;
    last_m_ = estimate.travelled_m;
  }
  bool long_enough() const { return start_ && last_m_ - start_->travelled_m >= kHeld_m; }
  const std::optional<FoundStart>& start() const { return start_; }

 private:
  static constexpr double kHeld_m = 10.0;  // there is no hurry: of a thousand first poses one is wrong
  static constexpr double kJump_m = 0.5;   // what makes a pose wrong
  std::optional<FoundStart> start_;
  Pose2 last_;
  double last_m_ = 0.0;
};

}  // namespace

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
  Holding holding;
  const auto played = play_logs(
      session, logs, play, what,
      [&](const io::RecordingHeader& header) { localizer.emplace((*joint)(header.rig)); },
      [&](const SensorEvent& event) {
        feed(*localizer, event);
        if (std::holds_alternative<LaserScan>(event)) holding.observe(localizer->estimate());
        return !holding.long_enough();
      });
  if (!played) return played.error();
  return holding.start();
}

}  // namespace mstsl::app
