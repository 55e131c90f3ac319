#include "mstsl/io/field_map_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <netcdf.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "field_map_check.hpp"
#include "file_problem.hpp"
#include "netcdf_file.hpp"
#include "seal.hpp"

namespace mstsl::io {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{4} << 30;
constexpr std::size_t kMaxFingerprints = 100'000'000;
constexpr std::string_view kHyperparameter = "hyperparameter_";

struct Component {
  const char* mean;
  const char* variance;
  const char* fingerprint;
  const char* direction;
};
constexpr std::array<Component, 3> kComponents{{{"bx", "bx_variance", "fp_bx", "along map x"},
                                                {"by", "by_variance", "fp_by", "along map y"},
                                                {"bz", "bz_variance", "fp_bz", "upwards"}}};

/// Cell centres along one axis: in the map frame for a grid that is not turned, else in the grid's frame.
std::vector<double> cell_centers(const GridGeometry& geometry, int count, double origin_m) {
  const double start_m = geometry.map_T_grid.yaw == 0.0 ? origin_m : 0.0;
  std::vector<double> centers_m(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < centers_m.size(); ++i)
    centers_m[i] = start_m + (static_cast<double>(i) + 0.5) * geometry.resolution_m;
  return centers_m;
}

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
  for (std::size_t k = 0; k < kComponents.size(); ++k) {
    const Component& c = kComponents[k];
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
}

void write_fingerprints(NetcdfWriter& file, const std::vector<Fingerprint>& fingerprints) {
  if (fingerprints.empty()) return;
  const int dimension = file.dimension("fingerprint", fingerprints.size());
  const auto write = [&](const char* name, const char* unit, const std::string& long_name,
                         const std::function<double(const Fingerprint&)>& value) {
    describe(file, file.variable(name, {dimension}, column<double, Fingerprint>(fingerprints, value)), unit,
             long_name);
  };
  write("fp_x", "m", "x of the fingerprint in the map frame",
        [](const Fingerprint& f) { return f.position_m.x(); });
  write("fp_y", "m", "y of the fingerprint in the map frame",
        [](const Fingerprint& f) { return f.position_m.y(); });
  for (std::size_t k = 0; k < kComponents.size(); ++k)
    write(kComponents[k].fingerprint, "uT",
          fmt::format("measured magnetic flux density {}", kComponents[k].direction),
          [k](const Fingerprint& f) { return f.field_uT[static_cast<Eigen::Index>(k)]; });
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
  if (map.provenance.empty()) return;
  global("provenance", map.provenance);
  global("history", fmt::format("{}", fmt::join(map.provenance, "\n")));
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
  for (std::size_t k = 0; k < kComponents.size(); ++k) {
    const auto mean = file.floats(kComponents[k].mean, {"y", "x"}, "uT");
    const auto variance = file.floats(kComponents[k].variance, {"y", "x"}, "uT2");
    for (std::size_t i = 0; i < mean.size(); ++i) {
      map.mean_uT[i][static_cast<Eigen::Index>(k)] = mean[i];
      map.variance_uT2[i][static_cast<Eigen::Index>(k)] = variance[i];
    }
  }
  map.supported = file.bytes("supported", {"y", "x"});
}

std::vector<Fingerprint> read_fingerprints(const NetcdfReader& file) {
  const std::size_t count = file.dimension("fingerprint").value_or(0);
  if (count == 0) return {};
  if (count > kMaxFingerprints) throw FileProblem("it claims {} fingerprints", count);
  std::vector<Fingerprint> fingerprints(count);
  const auto read = [&](const char* name, const char* unit, const auto& put) {
    const std::vector<double> values = file.doubles(name, {"fingerprint"}, unit);
    for (std::size_t i = 0; i < count; ++i) put(fingerprints[i], values[i]);
  };
  read("fp_x", "m", [](Fingerprint& f, double v) { f.position_m.x() = v; });
  read("fp_y", "m", [](Fingerprint& f, double v) { f.position_m.y() = v; });
  for (std::size_t k = 0; k < kComponents.size(); ++k)
    read(kComponents[k].fingerprint, "uT",
         [k](Fingerprint& f, double v) { f.field_uT[static_cast<Eigen::Index>(k)] = v; });
  return fingerprints;
}

FieldModel read_model(const NetcdfReader& file) {
  const std::string name = file.text("model");
  const auto model = field_model_from(name);
  if (!model)
    throw FileProblem("the attribute 'model' is '{}'; gpr, bilinear and fingerprint are known", name);
  return *model;
}

}  // namespace

Result<std::string> encode_field_map(const FieldMap& map, const std::filesystem::path& name) {
  return guarded(name, [&] {
    check_field_map(map);
    NetcdfWriter file;
    write_attributes(file, map);
    write_grid(file, map);
    write_fingerprints(file, map.fingerprints);
    return sealed(file.finish());
  });
}

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
    map.fingerprints = read_fingerprints(file);
    check_field_map(map);
    return map;
  });
}

Result<void> write_field_map(const FieldMap& map, const std::filesystem::path& file) {
  const Result<std::string> bytes = encode_field_map(map, file);
  if (!bytes) return bytes.error();
  return write_file(file, *bytes);
}

Result<FieldMap> read_field_map(const std::filesystem::path& file) {
  const Result<std::string> bytes = read_file(file, kMaxFileBytes);
  if (!bytes) return bytes.error();
  return decode_field_map(*bytes, file);
}

}  // namespace mstsl::io
