#pragma once

#include <string>
#include <vector>

#include "mstsl/magnetic/field_check.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/survey_analysis.hpp"

#include "survey_reader.hpp"

namespace mstsl::app {

/// Another drive, and how well the map foretold it.
struct CheckedLog {
  std::string name;
  FieldCheck check;
};

/// What `mstsl map magnetic` tells of a map it made: for people, and as one JSON object.
std::string map_report_text(const SurveyLogs& logs, const SurveyAnalysis& analysis, const FieldMap& map,
                            const std::vector<CheckedLog>& checks);
std::string map_report_json(const SurveyLogs& logs, const SurveyAnalysis& analysis, const FieldMap& map,
                            const std::vector<CheckedLog>& checks);

}  // namespace mstsl::app
