#include "mstsl/magnetic/field_check.hpp"

#include <vector>

namespace mstsl {

FieldCheck check_field_map(const FieldMap& map, std::span<const Fingerprint> fingerprints) {
  FieldCheck check;
  std::vector<HeldOutError> errors;
  for (const Fingerprint& f : fingerprints) {
    if (const auto foretold = map.at(f.position_m))
      errors.push_back({(f.field_uT - foretold->mean_uT).array(), foretold->variance_uT2.array()});
    else
      ++check.without_value;
  }
  for (const HeldOutError& e : errors) check.mean_error_uT += e.error_uT / static_cast<double>(errors.size());
  check.score = score(errors, {});  // the map's variance is that of a reading already
  return check;
}

}  // namespace mstsl
