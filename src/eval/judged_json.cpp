#include "judged_json.hpp"

namespace mstsl {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<JudgedInitialisation>& start) {
  if (!start) return nullptr;
  return Json::array({start->hypotheses, start->best_error_m, start->first_error_m, start->succeeded});
}
std::optional<JudgedInitialisation> initialisation_from(const Json& j) {
  if (j.is_null()) return std::nullopt;
  return JudgedInitialisation{j.at(0), j.at(1), j.at(2), j.at(3)};
}

}  // namespace

std::optional<double> number_from(const Json& j) {
  return j.is_null() ? std::nullopt : std::optional<double>(j.get<double>());
}

Json json_of(const JudgedAnswer& a) {
  Json list{a.travelled_m, a.probability, a.error.position_m, a.error.yaw_rad, a.right, a.tight};
  if (a.nees) list.push_back(*a.nees);
  return list;
}
JudgedAnswer answer_from(const Json& j) {
  JudgedAnswer answer{j.at(0), j.at(1), {j.at(2), j.at(3)}, j.at(4), j.at(5)};
  if (j.size() > 6) answer.nees = j.at(6);
  return answer;
}

Json json_of(const std::optional<JudgedAnswer>& answer) { return answer ? json_of(*answer) : Json(nullptr); }
std::optional<JudgedAnswer> optional_answer_from(const Json& j) {
  return j.is_null() ? std::nullopt : std::optional<JudgedAnswer>(answer_from(j));
}

Json json_of(const RunEvaluation& run) {
  Json answers = Json::array();
  for (const JudgedAnswer& answer : run.answers) answers.push_back(json_of(answer));
  return {{"estimates", run.estimates},
          {"without_truth", run.without_truth},
          {"initialisation", json_of(run.initialisation)},
          {"answers", answers},
          {"last", json_of(run.last)},
          {"cld_m", json_of(run.correct_distance_m)},
          {"times_lost", run.times_lost}};
}
RunEvaluation evaluation_from(const Json& j) {
  RunEvaluation run;
  run.estimates = j.at("estimates");
  run.without_truth = j.at("without_truth");
  run.initialisation = initialisation_from(j.at("initialisation"));
  for (const Json& answer : j.at("answers")) run.answers.push_back(answer_from(answer));
  run.last = optional_answer_from(j.at("last"));
  run.correct_distance_m = number_from(j.at("cld_m"));
  run.times_lost = j.at("times_lost");
  return run;
}

}  // namespace mstsl
