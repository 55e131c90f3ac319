#include <array>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "mstsl/io/recording.hpp"

#include "io/log/event_filter.hpp"
#include "io/log/event_order.hpp"
#include "io/log/event_source.hpp"
#include "io/log/open_source.hpp"

namespace mstsl::io {
namespace {

using OnHeader = std::function<void(const RecordingHeader&)>;
using OnEvent = std::function<bool(const SensorEvent&)>;

bool is_same(const Rig& a, const Rig& b) {
  return a.base_T_laser.isApprox(b.base_T_laser) && a.base_T_magnetometer.isApprox(b.base_T_magnetometer);
}

/// Gives on a whole play: one recording after the other.
class Player {
 public:
  Player(const PlayOptions& options, const OnHeader& on_header, const OnEvent& on_event)
      : options_(options), on_header_(on_header), on_event_(on_event) {}

  /// False: the receiver wants no more.
  Result<bool> play(const std::filesystem::path& path);
  /// To be called when all was played: names the sensors none of whose messages survived.
  void check_sensors();
  PlayReport report() && { return std::move(report_); }

 private:
  void announce(const EventSource& source);
  /// Puts the restart between two recordings and watches the time between them.
  bool begin_recording(const std::string& name, Stamp first);

  const PlayOptions& options_;
  const OnHeader& on_header_;
  const OnEvent& on_event_;
  PlayReport report_;
  std::optional<Rig> rig_;
  std::optional<Stamp> last_;                                            ///< of the last event given on
  std::array<std::uint64_t, std::variant_size_v<SensorEvent>> given_{};  ///< events by kind
};

Result<bool> Player::play(const std::filesystem::path& path) {
  Result<std::unique_ptr<EventSource>> source = open_source(path, options_, report_);
  if (!source) return source.error();
  announce(**source);
  bool begun = false;
  const OnEvent give = [&](const SensorEvent& event) {
    const Stamp stamp = stamp_of(event);
    if (!std::exchange(begun, true) && !begin_recording((*source)->name(), stamp)) return false;
    last_ = stamp;
    ++given_[event.index()];
    if (const auto* field = std::get_if<FieldReading>(&event))
      return on_event_(FieldReading{field->stamp, options_.calibration.apply(field->sensor_field_uT)});
    return on_event_(event);
  };
  EventFilter filter(report_, give);
  EventOrder order(options_.reorder_window_s, (*source)->name(), report_,
                   [&filter](const SensorEvent& event) { return filter.push(event); });
  bool goes_on = true;
  (*source)->read(
      [&](Stamp log_time, SensorEvent event) { return goes_on = order.push(log_time, std::move(event)); },
      report_);
  return goes_on && order.finish();
}

void Player::check_sensors() {
  const auto check = [this](const std::string& topic, const SensorEvent& kind) {
    const auto seen = report_.messages.find(topic);
    if (seen == report_.messages.end() || given_[kind.index()] > 0) return;
    report_.warnings.push_back(fmt::format(
        "none of the {} messages on {} could be used; see the counts of problems", seen->second, topic));
  };
  check(options_.topics.scan, LaserScan{});
  check(options_.topics.magnetic_field, FieldReading{});
  check(options_.topics.odometry, OdometryReading{});
  check(options_.topics.imu, ImuReading{});
  check(options_.topics.pose, PoseReading{});
}

void Player::announce(const EventSource& source) {
  if (!rig_) {
    rig_ = source.rig();
    if (on_header_) on_header_({*rig_});
  } else if (!is_same(*rig_, source.rig())) {
    report_.warnings.push_back(
        source.name() +
        ": its sensors sit elsewhere on the robot than in the first log; the first log's mountings are kept");
  }
}

bool Player::begin_recording(const std::string& name, Stamp first) {
  if (!last_) return true;
  if (first < *last_)
    report_.warnings.push_back(
        name + ": begins before the end of the log before it; give the logs in the order of their times");
  return on_event_(OdometryRestart{first});
}

}  // namespace

Result<PlayReport> play(const std::vector<std::filesystem::path>& files, const PlayOptions& options,
                        const OnHeader& on_header, const OnEvent& on_event) {
  if (files.empty()) return Error("no log is given");
  if (!(options.reorder_window_s >= 0.0 && options.reorder_window_s <= 60.0))
    return Error(
        fmt::format("the reorder window is {} s; choose one from 0 to 60 s", options.reorder_window_s));
  Player player(options, on_header, on_event);
  for (const std::filesystem::path& file : files) {
    try {
      const Result<bool> goes_on = player.play(file);
      if (!goes_on) return goes_on.error();
      if (!*goes_on) return std::move(player).report();
    } catch (const std::bad_alloc&) {
      return Error(file.string() + ": playing it needs more memory than there is");
    }
  }
  player.check_sensors();
  return std::move(player).report();
}

}  // namespace mstsl::io
