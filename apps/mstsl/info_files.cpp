#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "mstsl/io/estimates.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/truth.hpp"

#include "info.hpp"
#include "report_words.hpp"

namespace mstsl::app {
namespace {

Description pose(const Pose2& pose) { return {{"x_m", pose.x}, {"y_m", pose.y}, {"yaw_rad", pose.yaw}}; }

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void add_geometry(Description& description, const GridGeometry& geometry) {
  description["columns"] = geometry.columns;
  description["rows"] = geometry.rows;
  description["width_m"] = geometry.columns * geometry.resolution_m;
  description["height_m"] = geometry.rows * geometry.resolution_m;
  description["resolution_m"] = geometry.resolution_m;
  description["origin"] = pose(geometry.map_T_grid);
}

/// Mean, standard deviation, least and greatest of values; expects at least one.
Description statistics(const std::string& name, const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  const double squares = std::accumulate(values.begin(), values.end(), 0.0, [mean](double sum, double value) {
    return sum + (value - mean) * (value - mean);
  });
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return {{"quantity", name},
          {"mean_uT", mean},
          {"deviation_uT", std::sqrt(squares / n)},
          {"least_uT", *least},
          {"greatest_uT", *greatest}};
}

/// One row a component, of the cells that fingerprints support.
Description field_statistics(const FieldMap& field) {
  std::vector<std::vector<double>> columns(5);
  for (std::size_t i = 0; i < field.mean_uT.size(); ++i) {
    if (field.supported[i] == 0) continue;
    const Eigen::Vector3d mean = field.mean_uT[i].cast<double>();
    for (Eigen::Index k = 0; k < 3; ++k) columns[static_cast<std::size_t>(k)].push_back(mean[k]);
    columns[3].push_back(mean.norm());
    columns[4].push_back(std::sqrt(field.variance_uT2[i].cast<double>().mean()));
  }
  Description rows = Description::array();
  const std::vector<std::string> names{"Bx", "By", "Bz", "|B|", "claimed deviation"};
  for (std::size_t k = 0; k < names.size(); ++k)
    if (!columns[k].empty()) rows.push_back(statistics(names[k], columns[k]));
  return rows;
}

Description to_json(const io::SummaryValue& value) {
  return std::visit([](const auto& v) { return Description(v); }, value);
}

}  // namespace

Result<Description> describe_map(const std::filesystem::path& file) {
  const Result<io::MapFile> map = io::read_map_file(file);
  if (!map) return map.error();
  const double cell_m2 = std::pow(map->grid.geometry().resolution_m, 2);
  const auto area_m2 = [&](CellState state) {
    return cell_m2 * static_cast<double>(count(map->grid, state));
  };
  Description description{{"file", file.string()}, {"kind", "occupancy map"}, {"image", map->image.string()}};
  add_geometry(description, map->grid.geometry());
  description["free_m2"] = area_m2(CellState::kFree);
  description["occupied_m2"] = area_m2(CellState::kOccupied);
  description["unknown_m2"] = area_m2(CellState::kUnknown);
  description["warnings"] = map->warnings;
  return description;
}

Result<Description> describe_field(const std::filesystem::path& file) {
  const Result<FieldMap> field = io::read_field_map(file);
  if (!field) return field.error();
  const std::size_t cells = field->geometry.size();
  const auto supported =
      static_cast<std::size_t>(std::count(field->supported.begin(), field->supported.end(), 1));
  std::size_t valued = 0;
  for (std::size_t i = 0; i < cells; ++i) valued += field->has_value(field->geometry.cell(i)) ? 1 : 0;
  Description description{
      {"file", file.string()}, {"kind", "magnetic field map"}, {"model", to_string(field->model)}};
  add_geometry(description, field->geometry);
  description["magnetometer_height_m"] = field->height_m;
  description["cells_with_a_value_percent"] = percent(valued, cells);
  description["cells_supported_percent"] = percent(supported, cells);
  description["supported_m2"] = static_cast<double>(supported) * std::pow(field->geometry.resolution_m, 2);
  description["fingerprints"] = field->fingerprints.size();
  description["hyperparameters"] = field->hyperparameters;
  description["field_of_supported_cells"] = field_statistics(*field);
  description["drives"] = drives_json(*field);
  description["provenance"] = field->provenance;
  return description;
}

Result<Description> describe_estimates(const std::filesystem::path& file) {
  const Result<io::EstimatesFile> run = io::read_estimates(file);
  if (!run) return run.error();
  const std::vector<Estimate>& all = run->estimates;
  Description description{{"file", file.string()}, {"kind", "estimates"}, {"scans", all.size()}};
  for (const auto status :
       {LocalizationStatus::kSearching, LocalizationStatus::kLocalized, LocalizationStatus::kLost})
    description[std::string("scans_") + std::string(to_string(status))] =
        std::ranges::count(all, status, &Estimate::status);
  const auto fix = std::ranges::find(all, LocalizationStatus::kLocalized, &Estimate::status);
  description["first_fix_after_m"] = fix == all.end() ? Description() : Description(fix->travelled_m);
  if (!all.empty()) {
    description["duration_s"] = all.back().stamp - all.front().stamp;
    description["travelled_m"] = all.back().travelled_m;
    description["last_status"] = to_string(all.back().status);
    description["last_pose"] = all.back().map_T_base ? pose(*all.back().map_T_base) : Description();
    description["last_probability"] = all.back().probability;
  }
  description["complete"] = run->summary.has_value();
  for (const auto& [name, value] : run->summary.value_or(io::Summary{}))
    description["summary"][name] = to_json(value);
  return description;
}

Result<Description> describe_truth(const std::filesystem::path& file) {
  const Result<std::vector<PoseReading>> poses = io::read_truth(file);
  if (!poses) return poses.error();
  double length_m = 0.0;
  for (std::size_t i = 1; i < poses->size(); ++i)
    length_m += distance((*poses)[i - 1].map_T_base, (*poses)[i].map_T_base);
  return Description{{"file", file.string()},
                     {"kind", "true poses"},
                     {"poses", poses->size()},
                     {"duration_s", poses->back().stamp - poses->front().stamp},
                     {"path_m", length_m},
                     {"first_pose", pose(poses->front().map_T_base)},
                     {"last_pose", pose(poses->back().map_T_base)}};
}

}  // namespace mstsl::app
