#pragma once

#include <array>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "mstsl/core/stamp.hpp"
#include "mstsl/magnetic/field_map.hpp"

namespace mstsl::app {

/// "1.00 2.00 3.00 uT".
std::string three(const Eigen::Array3d& v, const char* unit);
std::array<double, 3> list(const Eigen::Array3d& v);

/// A log's time as a date, "2026-03-01 10:12 UTC"; where its clock was never set, as seconds.
std::string date(Stamp stamp);

/// Which drives a map is made of, how old they are, and how much of it each of them saw last. Nothing where
/// the map does not know its drives.
std::string drives_text(const FieldMap& map);
nlohmann::ordered_json drives_json(const FieldMap& map);

/// What the survey covered of the ground, and what it left out.
std::string coverage_text(const FieldMap& map);
nlohmann::ordered_json coverage_json(const FieldMap& map);

}  // namespace mstsl::app
