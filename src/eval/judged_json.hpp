#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "mstsl/eval/metrics.hpp"

namespace mstsl {

// What was judged, as JSON and back, to the last bit. Reading throws nlohmann's exceptions where it is not
// that.

template <typename T>
nlohmann::ordered_json json_of(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}
std::optional<double> number_from(const nlohmann::ordered_json& json);

nlohmann::ordered_json json_of(const JudgedAnswer& answer);
nlohmann::ordered_json json_of(const std::optional<JudgedAnswer>& answer);
JudgedAnswer answer_from(const nlohmann::ordered_json& json);
std::optional<JudgedAnswer> optional_answer_from(const nlohmann::ordered_json& json);

nlohmann::ordered_json json_of(const RunEvaluation& run);
RunEvaluation evaluation_from(const nlohmann::ordered_json& json);

}  // namespace mstsl
