#include "mstsl/eval/run_loop.hpp"

namespace mstsl {
namespace {

void count(const SensorEvent& event, RunCounts& counts) {
  if (std::holds_alternative<OdometryReading>(event)) ++counts.odometry;
  if (std::holds_alternative<LaserScan>(event)) ++counts.scans;
  if (std::holds_alternative<FieldReading>(event)) ++counts.field_readings;
  if (!counts.first_event) counts.first_event = stamp_of(event);
}

}  // namespace

void RunLoop::observe(const SensorEvent& event) {
  count(event, counts_);
  feed(localizer_, event);
  if (const auto* scan = std::get_if<LaserScan>(&event)) publish(*scan);
}

void RunLoop::publish(const LaserScan& scan) {
  const Estimate estimate = localizer_.estimate();
  const bool processed = estimate.stamp == scan.stamp && estimate.stamp != last_estimate_;
  if (!processed) return;
  last_estimate_ = estimate.stamp;
  ++counts_.estimates;
  counts_.last_status = estimate.status;
  if (estimate.map_T_base && !counts_.time_to_fix_s) {
    counts_.time_to_fix_s = estimate.stamp - *counts_.first_event;
    counts_.distance_to_fix_m = estimate.travelled_m;
  }
  on_estimate_(estimate);
}

}  // namespace mstsl
