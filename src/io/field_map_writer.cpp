#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <netcdf.h>

#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/field_map_file.hpp"

#include "field_map_check.hpp"
#include "field_map_layout.hpp"
#include "file_problem.hpp"
#include "netcdf_file.hpp"
#include "seal.hpp"

namespace mstsl::io {
namespace {

template <typename T, typename Item>
std::vector<T> column(const std::vector<Item>& items, const std::function<T(const Item&)>& value) {
  std::vector<T> values(items.size());
  std::transform(items.begin(), items.end(), values.begin(), value);
  return values;
}

void describe(NetcdfWriter& file, int variable, const char* unit, const std::string& long_name) {
  file.attribute(variable, "units", std::string_view(unit));
  file.attribute(variable, "long_name", long_name);
}

void write_axis(NetcdfWriter& file, const char* name, const char* axis, int dimension,
                const std::vector<double>& centers_m, bool turned) {
  const int variable = file.variable(name, {dimension}, centers_m);
  describe(file, variable, "m",
           fmt::format("{} of the cell's centre in the {} frame", name, turned ? "grid" : "map"));
  file.attribute(variable, "axis", std::string_view(axis));
}

void write_grid(NetcdfWriter& file, const FieldMap& map) {
  const GridGeometry& g = map.geometry;
  const int y = file.dimension("y", static_cast<std::size_t>(g.rows));
  const int x = file.dimension("x", static_cast<std::size_t>(g.columns));
  const bool turned = g.map_T_grid.yaw != 0.0;
  write_axis(file, "x", "X", x, cell_centers(g, g.columns, g.map_T_grid.x), turned);
  write_axis(file, "y", "Y", y, cell_centers(g, g.rows, g.map_T_grid.y), turned);
  for (std::size_t k = 0; k < kFieldComponents.size(); ++k) {
    const FieldComponent& c = kFieldComponents[k];
    const auto component = [k](const Eigen::Vector3f& v) { return v[static_cast<Eigen::Index>(k)]; };
    const int mean = file.variable(c.mean, {y, x}, column<float, Eigen::Vector3f>(map.mean_uT, component));
    describe(file, mean, "uT", fmt::format("magnetic flux density {}", c.direction));
    file.attribute(mean, "ancillary_variables", fmt::format("{} supported", c.variance));
    const int variance =
        file.variable(c.variance, {y, x}, column<float, Eigen::Vector3f>(map.variance_uT2, component));
    describe(file, variance, "uT2", fmt::format("variance of the magnetic flux density {}", c.direction));
  }
  const int supported = file.variable("supported", {y, x}, map.supported);
  file.attribute(supported, "long_name",
                 std::string_view("whether a fingerprint lies within the model's reach"));
  file.attribute(supported, "flag_values", std::vector<std::uint8_t>{0, 1});
  file.attribute(supported, "flag_meanings", std::string_view("unsupported supported"));
  if (map.newest_drive.empty()) return;
  const int newest = file.variable("newest_drive", {y, x}, map.newest_drive);
  file.attribute(newest, "long_name",
                 std::string_view("index of the last drive that came near, -1 where none did"));
}

/// Returns the dimension that the fingerprints are written over; expects some.
int write_fingerprints(NetcdfWriter& file, const std::vector<Fingerprint>& fingerprints,
                       const FingerprintTable& table, bool with_drives) {
  const int dimension = file.dimension(table.dimension, fingerprints.size());
  const auto write = [&](const std::string& name, const char* unit, const std::string& long_name,
                         const std::function<double(const Fingerprint&)>& value) {
    const std::vector<double> values = column<double, Fingerprint>(fingerprints, value);
    describe(file, file.variable((table.prefix + name).c_str(), {dimension}, values), unit, long_name);
  };
  write("x", "m", "x of the fingerprint in the map frame",
        [](const Fingerprint& f) { return f.position_m.x(); });
  write("y", "m", "y of the fingerprint in the map frame",
        [](const Fingerprint& f) { return f.position_m.y(); });
  for (std::size_t k = 0; k < kFieldComponents.size(); ++k)
    write(kFieldComponents[k].mean, "uT",
          fmt::format("measured magnetic flux density {}", kFieldComponents[k].direction),
          [k](const Fingerprint& f) { return f.field_uT[static_cast<Eigen::Index>(k)]; });
  if (!with_drives) return dimension;
  write("heading", "rad", "yaw of the robot in the map frame",
        [](const Fingerprint& f) { return f.heading_rad; });
  const auto drive = [](const Fingerprint& f) { return static_cast<std::int32_t>(f.session); };
  const int variable = file.variable((std::string(table.prefix) + kDrive).c_str(), {dimension},
                                     column<std::int32_t, Fingerprint>(fingerprints, drive));
  file.attribute(variable, "long_name", std::string_view("index of the drive it comes from"));
  return dimension;
}

/// The drives of the survey and of later updates, and what each of them has to do with the map.
void write_drives(NetcdfWriter& file, const FieldMap& map) {
  if (map.drives.empty()) return;
  const int drive = file.dimension(kDrive, map.drives.size());
  const auto write = [&](const char* name, const char* long_name, Stamp SurveyDrive::*stamp) {
    const int variable = file.variable(
        name, {drive}, column<std::int64_t, SurveyDrive>(map.drives, [stamp](const SurveyDrive& d) {
          return (d.*stamp).ns;
        }));
    describe(file, variable, kStampUnit, long_name);
  };
  write("drive_begin", "time of the drive's first message, by its log's clock", &SurveyDrive::first);
  write("drive_end", "time of the drive's last message, by its log's clock", &SurveyDrive::last);
  if (map.replaced.empty()) return;
  std::vector<Fingerprint> fingerprints;
  for (const ReplacedFingerprint& r : map.replaced) fingerprints.push_back(r.fingerprint);
  const int dimension = write_fingerprints(file, fingerprints, kReplaced, true);
  const int by =
      file.variable("replaced_fp_by_drive", {dimension},
                    column<std::int32_t, ReplacedFingerprint>(map.replaced, [](const ReplacedFingerprint& r) {
                      return static_cast<std::int32_t>(r.by_session);
                    }));
  file.attribute(by, "long_name", std::string_view("index of the drive that found another field there"));
}

void write_attributes(NetcdfWriter& file, const FieldMap& map) {
  const auto global = [&](const std::string& name, const auto& value) {
    file.attribute(NC_GLOBAL, name.c_str(), value);
  };
  global("Conventions", std::string_view("CF-1.8"));
  global("title", std::string_view("Magnetic field map of a building"));
  global("source", fmt::format("mstsl, model {}", to_string(map.model)));
  global("model", to_string(map.model));
  global("resolution_m", map.geometry.resolution_m);
  global("grid_origin_x_m", map.geometry.map_T_grid.x);
  global("grid_origin_y_m", map.geometry.map_T_grid.y);
  global("grid_yaw_rad", map.geometry.map_T_grid.yaw);
  global("height_m", map.height_m);
  for (const auto& [name, value] : map.hyperparameters) global(std::string(kHyperparameter) + name, value);
  if (!map.drives.empty())
    global(kDriveNames,
           column<std::string, SurveyDrive>(map.drives, [](const SurveyDrive& d) { return d.name; }));
  if (map.provenance.empty()) return;
  global("provenance", map.provenance);
  global("history", fmt::format("{}", fmt::join(map.provenance, "\n")));
}

}  // namespace

std::vector<double> cell_centers(const GridGeometry& geometry, int count, double origin_m) {
  const double start_m = geometry.map_T_grid.yaw == 0.0 ? origin_m : 0.0;
  std::vector<double> centers_m(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < centers_m.size(); ++i)
    centers_m[i] = start_m + (static_cast<double>(i) + 0.5) * geometry.resolution_m;
  return centers_m;
}

Result<std::string> encode_field_map(const FieldMap& map, const std::filesystem::path& name) {
  return guarded(name, [&] {
    check_field_map(map);
    NetcdfWriter file;
    write_attributes(file, map);
    write_grid(file, map);
    if (!map.fingerprints.empty()) write_fingerprints(file, map.fingerprints, kCurrent, !map.drives.empty());
    write_drives(file, map);
    return sealed(file.finish());
  });
}

Result<void> write_field_map(const FieldMap& map, const std::filesystem::path& file) {
  const Result<std::string> bytes = encode_field_map(map, file);
  if (!bytes) return bytes.error();
  return write_file(file, *bytes);
}

}  // namespace mstsl::io
