#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/run_trace.hpp"

#include "run_picture.hpp"

namespace mstsl::app {

/// Keeps what there is to see of a run as it goes by, to be looked at again in a browser.
class RunReport {
 public:
  explicit RunReport(const Rig& rig) : scans_(rig) {}
  void observe(const SensorEvent& event) { scans_.observe(event); }

  /// Writes the page. The estimates are read from `files`; `method` made them.
  Result<void> write(const RunFiles& files, const std::string& title, const std::string& method,
                     const std::filesystem::path& page);

 private:
  ScanRecorder scans_;
};

}  // namespace mstsl::app
