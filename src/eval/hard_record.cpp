#include "mstsl/eval/hard_record.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

#include "judged_json.hpp"

namespace mstsl {
namespace {

using Json = nlohmann::ordered_json;
using mstsl::json_of;

constexpr double kFirstEdge_ms = 0.001, kGrowth = 1.12;

/// Pairs of bin and count: most bins are empty.
Json json_of(const CostHistogram& histogram) {
  Json pairs = Json::array();
  for (std::size_t i = 0; i < CostHistogram::kBins; ++i)
    if (histogram.bins[i] > 0) pairs.push_back({i, histogram.bins[i]});
  return {{"max_ms", histogram.max_ms_}, {"bins", pairs}};
}
CostHistogram histogram_from(const Json& j) {
  CostHistogram histogram;
  histogram.max_ms_ = j.at("max_ms");
  for (const Json& pair : j.at("bins")) histogram.bins.at(pair.at(0).get<std::size_t>()) = pair.at(1);
  return histogram;
}

Json json_of(const KidnapOutcome& k) {
  return {{"localized_before", k.localized_before},
          {"noticed_m", json_of(k.noticed_m)},
          {"recovered_m", json_of(k.recovered_m)},
          {"wrong_again", k.wrong_again}};
}

HardRecord record_from(const Json& j) {
  HardRecord r;
  r.key = {j.at("set"), j.at("world"), j.at("disturbance"), j.at("method"), j.at("run")};
  r.options = j.at("options");
  r.driven_m = j.at("driven_m");
  r.duration_s = j.at("duration_s");
  r.estimates = j.at("estimates");
  r.answers = j.at("answers");
  r.claims_at_99 = j.at("at_99").at(1), r.wrong_at_99 = j.at("at_99").at(0);
  r.claims_at_999 = j.at("at_999").at(1), r.wrong_at_999 = j.at("at_999").at(0);
  r.first = optional_answer_from(j.at("first"));
  r.last = optional_answer_from(j.at("last"));
  r.first_s = number_from(j.at("first_s"));
  r.correct_distance_m = number_from(j.at("cld_m"));
  for (const Json& answer : j.at("sample")) r.sample.push_back(answer_from(answer));
  r.times_lost = j.at("times_lost");
  r.false_alarms = j.at("false_alarms");
  r.right_m = j.at("right_m");
  if (const Json& k = j.at("kidnap"); !k.is_null())
    r.kidnap = KidnapOutcome{k.at("localized_before"), number_from(k.at("noticed_m")),
                             number_from(k.at("recovered_m")), k.at("wrong_again")};
  r.searching = histogram_from(j.at("cost").at("searching"));
  r.tracking = histogram_from(j.at("cost").at("tracking"));
  r.simulation_ms = j.at("cost").at("simulation_ms");
  return r;
}

}  // namespace

void CostHistogram::add(double ms) {
  const double place = ms > kFirstEdge_ms ? std::ceil(std::log(ms / kFirstEdge_ms) / std::log(kGrowth)) : 0.0;
  ++bins[std::min(kBins - 1, static_cast<std::size_t>(place))];
  max_ms_ = std::max(max_ms_, ms);
}

void CostHistogram::add(const CostHistogram& other) {
  for (std::size_t i = 0; i < kBins; ++i) bins[i] += other.bins[i];
  max_ms_ = std::max(max_ms_, other.max_ms_);
}

std::size_t CostHistogram::count() const { return std::accumulate(bins.begin(), bins.end(), std::size_t{0}); }

double CostHistogram::quantile_ms(double q) const {
  const double wanted = q * static_cast<double>(count());
  std::size_t seen = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    seen += bins[i];
    if (seen > 0 && static_cast<double>(seen) >= wanted)
      return std::min(max_ms_, kFirstEdge_ms * std::pow(kGrowth, static_cast<double>(i)));
  }
  return 0.0;
}

std::string to_line(const HardRecord& r) {
  Json sample = Json::array();
  for (const JudgedAnswer& answer : r.sample) sample.push_back(json_of(answer));
  const Json j{{"set", r.key.set},
               {"world", r.key.world},
               {"disturbance", r.key.disturbance},
               {"method", r.key.method},
               {"run", r.key.run},
               {"options", r.options},
               {"driven_m", r.driven_m},
               {"duration_s", r.duration_s},
               {"estimates", r.estimates},
               {"answers", r.answers},
               {"at_99", Json::array({r.wrong_at_99, r.claims_at_99})},
               {"at_999", Json::array({r.wrong_at_999, r.claims_at_999})},
               {"first", json_of(r.first)},
               {"first_s", json_of(r.first_s)},
               {"last", json_of(r.last)},
               {"cld_m", json_of(r.correct_distance_m)},
               {"sample", sample},
               {"times_lost", r.times_lost},
               {"false_alarms", r.false_alarms},
               {"right_m", r.right_m},
               {"kidnap", r.kidnap ? json_of(*r.kidnap) : Json(nullptr)},
               {"cost",
                {{"simulation_ms", r.simulation_ms},
                 {"searching", json_of(r.searching)},
                 {"tracking", json_of(r.tracking)}}}};
  return j.dump();
}

Result<HardRecord> record_from_line(std::string_view line) {
  try {
    return record_from(Json::parse(line));
  } catch (const std::exception& error) {
    return Error(std::string("not a run's record: ") + error.what());
  }
}

}  // namespace mstsl
