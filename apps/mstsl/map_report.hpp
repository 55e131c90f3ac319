#pragma once

#include <string>

#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/survey_analysis.hpp"

#include "survey_reader.hpp"

namespace mstsl::app {

/// What `mstsl map magnetic` tells of a map it made: for people, and as one JSON object.
std::string map_report_text(const SurveyLogs& logs, const SurveyAnalysis& analysis, const FieldMap& map);
std::string map_report_json(const SurveyLogs& logs, const SurveyAnalysis& analysis, const FieldMap& map);

}  // namespace mstsl::app
