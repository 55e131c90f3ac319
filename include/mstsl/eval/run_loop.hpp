#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "mstsl/localize/localizer.hpp"

namespace mstsl {

/// What a run consisted of, so far.
struct RunCounts {
  std::uint64_t odometry = 0;
  std::uint64_t scans = 0;
  std::uint64_t field_readings = 0;
  std::uint64_t estimates = 0;
  std::optional<Stamp> first_event;
  std::optional<double> time_to_fix_s;      ///< from the first event to the first pose given
  std::optional<double> distance_to_fix_m;  ///< driven until then
  LocalizationStatus last_status = LocalizationStatus::kSearching;
};

/// The one evaluation loop: feeds any localizer its events in time order and hands on an estimate for each
/// scan that the localizer processed (it may pass scans over while the robot hardly moves).
class RunLoop {
 public:
  RunLoop(AnyLocalizer localizer, std::function<void(const Estimate&)> on_estimate)
      : localizer_(std::move(localizer)), on_estimate_(std::move(on_estimate)) {}

  void observe(const SensorEvent& event);

  const RunCounts& counts() const { return counts_; }
  const AnyLocalizer& localizer() const { return localizer_; }

 private:
  void publish(const LaserScan& scan);

  AnyLocalizer localizer_;
  std::function<void(const Estimate&)> on_estimate_;
  RunCounts counts_;
  std::optional<Stamp> last_estimate_;
};

}  // namespace mstsl
