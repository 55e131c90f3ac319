#include <array>
#include <utility>

#include <fmt/format.h>

#include "mstsl/localize/two_step.hpp"

namespace mstsl {
namespace {

std::optional<Error> not_positive(std::string_view name, double value) {
  if (value > 0.0) return std::nullopt;
  return Error(fmt::format("{} is {}; it must be more than 0", name, value));
}

std::optional<Error> no_share(std::string_view name, double value) {
  if (value >= 0.0 && value <= 1.0) return std::nullopt;
  return Error(fmt::format("{} is {}; it must be between 0 and 1", name, value));
}

}  // namespace

std::optional<Error> invalid(const TwoStepOptions& options) {
  if (options.initialise.distinct.count == 0) return Error("K is 0; at least one hypothesis is needed");
  const LidarStageOptions& lidar = options.lidar;
  if (lidar.max_sigma_m < lidar.min_sigma_m)
    return Error(fmt::format("max_sigma_m is {}; it must not be less than min_sigma_m, {}", lidar.max_sigma_m,
                             lidar.min_sigma_m));
  if (lidar.answer_distance_m < lidar.min_distance_m)
    return Error(fmt::format("answer_distance_m is {}; it must not be less than min_distance_m, {}",
                             lidar.answer_distance_m, lidar.min_distance_m));
  for (const auto& [name, value] :
       {std::pair<const char*, double>{"separation_m", options.initialise.distinct.separation_m},
        {"field_sigma_uT", options.initialise.field_sigma_uT},
        {"align_sigma_rad", options.initialise.align_sigma_rad},
        {"min_sigma_m", lidar.min_sigma_m},
        {"match_every_m", lidar.match_every_m},
        {"process_every_m", options.process_every_m},
        {"process_every_s", options.process_every_s},
        {"likelihood_temper", lidar.likelihood_temper}})
    if (auto error = not_positive(name, value)) return error;
  for (const auto& [name, value] : {std::pair<const char*, double>{"min_score", lidar.min_score},
                                    {"answer_share", lidar.answer_share},
                                    {"max_probability", lidar.max_probability},
                                    {"low_score", options.tracker.low_score}})
    if (auto error = no_share(name, value)) return error;
  return std::nullopt;
}

}  // namespace mstsl
