#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/magnetic/fingerprint_collector.hpp"

#include "session.hpp"
#include "survey_positions.hpp"

namespace mstsl::app {

/// What the logs of a survey gave.
struct SurveyLogs {
  std::vector<Fingerprint> fingerprints;
  CollectionReport collected;
  std::map<std::string, std::uint64_t> problems;  ///< of reading, by kind
  std::vector<std::string> warnings;
  double magnetometer_height_m = 0.0;
  std::vector<SurveyTrack> tracks;  ///< of the logs, where they had to be tracked
  std::vector<SurveyDrive> drives;  ///< by Fingerprint::session
};

/// Plays the logs, one session each, and collects their fingerprints at the places that the robot was at on
/// `map_T_base`, one trajectory a log; without any, at the poses in the logs. Errors: a log that cannot be
/// read, an interrupt.
Result<SurveyLogs> collect_fingerprints(const Session& session,
                                        const std::vector<std::filesystem::path>& logs,
                                        const io::PlayOptions& play,
                                        const std::vector<Trajectory>& map_T_base = {});

/// Plays the logs, one session each, and collects their fingerprints; with starts, one a log, where they lie
/// is found by tracking the robot from there. Errors: a log that cannot be read or tracked, an interrupt.
Result<SurveyLogs> read_survey(const Session& session, const std::vector<std::filesystem::path>& logs,
                               const io::PlayOptions& play, const std::vector<KnownStart>& starts = {});

}  // namespace mstsl::app
