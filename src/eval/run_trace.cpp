#include "mstsl/eval/run_trace.hpp"

namespace mstsl {

void ScanRecorder::observe(const SensorEvent& event) {
  const auto* scan = std::get_if<LaserScan>(&event);
  if (scan == nullptr) return;
  // A clock that jumped back is a new beginning.
  if (!scans_.empty() && scan->stamp >= scans_.back().stamp && scan->stamp - scans_.back().stamp < every_s_)
    return;
  constexpr double kSpacing_m = 0.1;
  constexpr std::size_t kPoints = 90;
  scans_.push_back(
      {scan->stamp, at_most(thinned(points_in_base(*scan, rig_.base_T_laser), kSpacing_m), kPoints)});
  if (scans_.size() < 2 * most_) return;
  for (std::size_t i = 1; 2 * i < scans_.size(); ++i) scans_[i] = std::move(scans_[2 * i]);
  scans_.resize(most_);
  every_s_ *= 2.0;
}

}  // namespace mstsl
