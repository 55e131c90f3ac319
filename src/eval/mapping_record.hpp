#pragma once

#include <nlohmann/json.hpp>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/mapping_protocol.hpp"

namespace mstsl {

/// A record as JSON, and back to the last bit. Errors: what is no such record.
nlohmann::ordered_json json_of(const MappingRecord& record);
Result<MappingRecord> mapping_record_from(const nlohmann::ordered_json& json);

}  // namespace mstsl
