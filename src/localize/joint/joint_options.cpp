#include <string>
#include <utility>

#include <fmt/format.h>

#include "mstsl/localize/joint/joint.hpp"

namespace mstsl {
namespace {

using Named = std::pair<const char*, double>;

std::optional<Error> not_positive(const JointOptions& o) {
  const joint::FieldModel& field = o.bank.field;
  for (const auto& [name, value] : {Named{"agree_m", o.agree_m},
                                    {"lost_after_m", o.lost_after_m},
                                    {"search_every_m", o.search_every_m},
                                    {"field_search_least_m", o.field_search_least_m},
                                    {"process_every_m", o.process_every_m},
                                    {"process_every_rad", o.process_every_rad},
                                    {"process_every_s", o.process_every_s},
                                    {"step_without_scan_m", o.step_without_scan_m},
                                    {"stations.spacing_m", o.stations.spacing_m},
                                    {"stations.turn_rad", o.stations.turn_rad},
                                    {"field.bias_sigma_uT", field.bias_sigma_uT},
                                    {"field.station_sigma_uT", field.station_sigma_uT},
                                    {"field.map_error_factor", field.map_error_factor},
                                    {"field.map_error_floor_uT", field.map_error_floor_uT},
                                    {"field.error_length_m", field.error_length_m},
                                    {"field.change_every_m", field.change_every_m},
                                    {"field.change_length_m", field.change_length_m},
                                    {"field.scale_length_m", field.scale_length_m},
                                    {"scan.new_after_m", o.bank.scan.new_after_m},
                                    {"scan.sudden_after_m", o.bank.scan.sudden_after_m},
                                    {"lost_every_m", o.bank.lost_every_m}})
    if (!(value > 0.0)) return Error(fmt::format("{} is {}; it must be more than 0", name, value));
  return std::nullopt;
}

std::optional<Error> no_share(const JointOptions& o) {
  for (const auto& [name, value] : {Named{"lost_below", o.lost_below},
                                    {"search_above", o.search_above},
                                    {"field_temper", o.bank.field_temper},
                                    {"field.error_own_share", o.bank.field.error_own_share},
                                    {"elsewhere_prior", o.bank.elsewhere_prior},
                                    {"carried_in_the_dark", o.bank.carried_in_the_dark},
                                    {"scan.tolerance", o.bank.scan.tolerance},
                                    {"scan.elsewhere_score", o.bank.scan.elsewhere_score}})
    if (!(value > 0.0 && value < 1.0))
      return Error(fmt::format("{} is {}; it must lie between 0 and 1", name, value));
  return std::nullopt;
}

}  // namespace

std::optional<Error> invalid(const JointOptions& options) {
  if (!(options.localized_from > 0.5 && options.localized_from < 1.0))
    return Error("the probability from which a pose is published must lie between 0.5 and 1");
  if (!(options.lost_below < options.localized_from))
    return Error(fmt::format("a pose is taken back below {}, but published from {} on: it would flicker",
                             options.lost_below, options.localized_from));
  if (!(options.field_search_least_m < options.field_search_most_m))
    return Error(
        fmt::format("the field is searched for over at least {} m of the way, but only {} m are kept",
                    options.field_search_least_m, options.field_search_most_m));
  if (auto error = not_positive(options)) return error;
  return no_share(options);
}

}  // namespace mstsl
