#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/mapping/slam.hpp"

#include "session.hpp"

namespace mstsl::app {

/// Where on known maps a drive was at the first time that the joint method was sure of it, and stayed so for
/// the 10 m that followed (or to the drive's end).
struct FoundStart {
  Anchor anchor;
  double travelled_m = 0.0;  ///< until then
};

/// Nothing where the method is not sure until the drive's end. `what` labels the bar. Errors: a log that
/// cannot be read, an interrupt.
Result<std::optional<FoundStart>> find_start(const Session& session,
                                             const std::vector<std::filesystem::path>& logs,
                                             const io::PlayOptions& play,
                                             const std::shared_ptr<const LocalizationMaps>& maps,
                                             const std::string& what);

}  // namespace mstsl::app
