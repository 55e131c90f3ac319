#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "field_map_check.hpp"
#include "field_map_layout.hpp"
#include "file_problem.hpp"
#include "netcdf_file.hpp"
#include "seal.hpp"

namespace mstsl::io {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{4} << 30;
constexpr std::size_t kMaxFingerprints = 100'000'000;

std::vector<std::int32_t> small_integers(const NetcdfReader& file, const std::string& name,
                                         const std::vector<const char*>& dimensions) {
  std::vector<std::int32_t> values;
  for (const std::int64_t value : file.integers(name.c_str(), dimensions)) {
    if (!std::in_range<std::int32_t>(value)) throw FileProblem("'{}' holds {}", name, value);
    values.push_back(static_cast<std::int32_t>(value));
  }
  return values;
}

void check_axis(const std::vector<double>& found_m, const std::vector<double>& expected_m,
                double resolution_m, const char* name) {
  for (std::size_t i = 0; i < found_m.size(); ++i)
    if (!(std::abs(found_m[i] - expected_m[i]) < 0.01 * resolution_m))
      throw FileProblem(
          "the coordinate '{}' contradicts the attributes resolution_m and grid_origin_{}_m at index {} "
          "({} m, not {} m); was the file cropped or resampled?",
          name, name, i, found_m[i], expected_m[i]);
}

GridGeometry read_geometry(const NetcdfReader& file) {
  const auto columns = file.dimension("x");
  const auto rows = file.dimension("y");
  if (!columns || !rows)
    throw FileProblem("it has no dimensions x and y; is this a field map made by `mstsl map magnetic`?");
  constexpr std::size_t kMost = 1'000'000'000;
  GridGeometry g;
  g.columns = static_cast<int>(std::min(*columns, kMost));
  g.rows = static_cast<int>(std::min(*rows, kMost));
  g.resolution_m = file.number("resolution_m");
  g.map_T_grid =
      Pose2{file.number("grid_origin_x_m"), file.number("grid_origin_y_m"), file.number("grid_yaw_rad")};
  check_geometry(g);
  if (std::abs(g.map_T_grid.yaw) > kPi)
    throw FileProblem("grid_yaw_rad is {}; it must lie between -pi and pi", g.map_T_grid.yaw);
  check_axis(file.doubles("x", {"x"}, "m"), cell_centers(g, g.columns, g.map_T_grid.x), g.resolution_m, "x");
  check_axis(file.doubles("y", {"y"}, "m"), cell_centers(g, g.rows, g.map_T_grid.y), g.resolution_m, "y");
  return g;
}

void read_grid(const NetcdfReader& file, FieldMap& map) {
  map.mean_uT.resize(map.geometry.size());
  map.variance_uT2.resize(map.geometry.size());
  for (std::size_t k = 0; k < kFieldComponents.size(); ++k) {
    const auto mean = file.floats(kFieldComponents[k].mean, {"y", "x"}, "uT");
    const auto variance = file.floats(kFieldComponents[k].variance, {"y", "x"}, "uT2");
    for (std::size_t i = 0; i < mean.size(); ++i) {
      map.mean_uT[i][static_cast<Eigen::Index>(k)] = mean[i];
      map.variance_uT2[i][static_cast<Eigen::Index>(k)] = variance[i];
    }
  }
  map.supported = file.bytes("supported", {"y", "x"});
}

std::vector<Fingerprint> read_fingerprints(const NetcdfReader& file, const FingerprintTable& table,
                                           bool with_drives) {
  const std::size_t count = file.dimension(table.dimension).value_or(0);
  if (count == 0) return {};
  if (count > kMaxFingerprints) throw FileProblem("it claims {} fingerprints", count);
  std::vector<Fingerprint> fingerprints(count);
  const auto read = [&](const std::string& name, const char* unit, const auto& put) {
    const std::vector<double> values = file.doubles((table.prefix + name).c_str(), {table.dimension}, unit);
    for (std::size_t i = 0; i < count; ++i) put(fingerprints[i], values[i]);
  };
  read("x", "m", [](Fingerprint& f, double v) { f.position_m.x() = v; });
  read("y", "m", [](Fingerprint& f, double v) { f.position_m.y() = v; });
  for (std::size_t k = 0; k < kFieldComponents.size(); ++k)
    read(kFieldComponents[k].mean, "uT",
         [k](Fingerprint& f, double v) { f.field_uT[static_cast<Eigen::Index>(k)] = v; });
  if (!with_drives) return fingerprints;
  read("heading", "rad", [](Fingerprint& f, double v) { f.heading_rad = v; });
  const auto drives = small_integers(file, std::string(table.prefix) + kDrive, {table.dimension});
  for (std::size_t i = 0; i < count; ++i) fingerprints[i].session = drives[i];
  return fingerprints;
}

void read_drives(const NetcdfReader& file, FieldMap& map) {
  const std::vector<std::string> names = file.texts(kDriveNames);
  const auto begins = file.integers("drive_begin", {kDrive}), ends = file.integers("drive_end", {kDrive});
  if (names.size() != begins.size())
    throw FileProblem("the attribute '{}' names {} drives, but the file has {}", kDriveNames, names.size(),
                      begins.size());
  for (std::size_t i = 0; i < names.size(); ++i)
    map.drives.push_back({names[i], Stamp{begins[i]}, Stamp{ends[i]}});
  if (file.has_variable("newest_drive")) map.newest_drive = small_integers(file, "newest_drive", {"y", "x"});
  const std::vector<Fingerprint> replaced = read_fingerprints(file, kReplaced, true);
  if (replaced.empty()) return;
  const auto by = small_integers(file, "replaced_fp_by_drive", {kReplaced.dimension});
  for (std::size_t i = 0; i < replaced.size(); ++i) map.replaced.push_back({replaced[i], by[i]});
}

FieldModel read_model(const NetcdfReader& file) {
  const std::string name = file.text("model");
  const auto model = field_model_from(name);
  if (!model)
    throw FileProblem("the attribute 'model' is '{}'; gpr, bilinear and fingerprint are known", name);
  return *model;
}

}  // namespace

Result<FieldMap> decode_field_map(std::string_view bytes, const std::filesystem::path& name) {
  return guarded(name, [&] {
    check_seal(bytes);
    const NetcdfReader file(bytes);
    FieldMap map;
    map.model = read_model(file);
    map.geometry = read_geometry(file);
    map.height_m = file.number("height_m");
    map.hyperparameters = file.numbers(kHyperparameter);
    map.provenance = file.texts("provenance");
    read_grid(file, map);
    // Maps of before there were updates do not say which drive a fingerprint is of.
    const bool with_drives = file.dimension(kDrive).has_value();
    map.fingerprints = read_fingerprints(file, kCurrent, with_drives);
    if (with_drives) read_drives(file, map);
    check_field_map(map);
    return map;
  });
}

Result<FieldMap> read_field_map(const std::filesystem::path& file) {
  const Result<std::string> bytes = read_file(file, kMaxFileBytes);
  if (!bytes) return bytes.error();
  return decode_field_map(*bytes, file);
}

}  // namespace mstsl::io
