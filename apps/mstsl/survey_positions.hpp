#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/mapping/survey_tracker.hpp"

namespace mstsl::app {

/// Where each log of a survey begins, on a map that is known.
struct KnownStart {
  std::shared_ptr<const WallField> walls;
  Pose2 map_T_base;
  std::optional<Stamp> stamp = {};  ///< when it was there; what the log holds of before is left out
};

/// X,Y,YAW in m and rad.
Result<Pose2> pose_from(const std::string& text);

/// Where the robot was during a log, from its scans and odometry. `at` is told how far it is.
Result<SurveyTrack> track_survey(const std::filesystem::path& log, const io::PlayOptions& play,
                                 const KnownStart& start, const std::function<void(Stamp)>& at);

}  // namespace mstsl::app
