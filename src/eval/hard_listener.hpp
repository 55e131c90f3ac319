#pragma once

#include <optional>
#include <vector>

#include "mstsl/eval/hard_record.hpp"
#include "mstsl/eval/run_loop.hpp"
#include "mstsl/eval/run_trace.hpp"

namespace mstsl {

/// CPU time of this thread, ms.
double thread_cpu_ms();

/// One method listening to a run: its estimates and what they cost.
class HardListener {
 public:
  explicit HardListener(AnyLocalizer localizer, Traced traced = Traced::kNo);
  HardListener(const HardListener&) = delete;
  HardListener& operator=(const HardListener&) = delete;
  void observe(const SensorEvent& event);
  const std::vector<Estimate>& estimates() const { return estimates_; }
  double cpu_ms() const { return cpu_ms_; }

  /// Everything but key and options. `set_down`: when it stood elsewhere, if it was carried.
  HardRecord record(const Trajectory& truth, std::optional<Stamp> set_down) const;

 private:
  Traced traced_;
  std::vector<Estimate> estimates_;
  RunLoop loop_;
  double cpu_ms_ = 0.0, since_scan_ms_ = 0.0;
  CostHistogram searching_, tracking_;
};

}  // namespace mstsl
