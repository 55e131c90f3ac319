#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mstsl/core/result.hpp"

namespace mstsl {

/// The units in which magnetometer drivers are known to give the field, whatever their interface promises.
enum class FieldUnit : std::uint8_t { kTesla, kMicrotesla, kNanotesla, kGauss, kMilligauss, kNormalised };

std::string_view to_string(FieldUnit unit);

/// What one of the unit is in microtesla. "Normalised" is a field given as a multiple of a local strength
/// that is not told; it is taken as 50 uT, the Earth's field at mid latitudes (22 to 67 uT world-wide).
double microtesla_per(FieldUnit unit);

/// The unit in which readings of these norms would be a field found in a building: 10 to 150 uT, the Earth's
/// 22 to 67 uT bent by steel (in tesla, as the interface promises, 2 to 1000 uT). Judges by the median, so
/// that a few bad readings do no harm; norms that are not finite are passed over. Errors: no finite norm, or
/// no unit fits.
Result<FieldUnit> detect_unit(std::span<const double> norms);

}  // namespace mstsl
