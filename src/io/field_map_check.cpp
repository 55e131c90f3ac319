#include "field_map_check.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <utility>

#include "file_problem.hpp"

namespace mstsl::io {
namespace {

constexpr std::size_t kMaxCells = 100'000'000;  // 500 m squared at 5 cm: 2.5 GB in memory
constexpr double kMaxExtent_m = 1e8;            // as for occupancy maps

void check_cell(const FieldMap& map, std::size_t i) {
  const auto& mean = map.mean_uT[i];
  const auto& variance = map.variance_uT2[i];
  const Cell cell = map.geometry.cell(i);
  const bool empty = mean.array().isNaN().all() && variance.array().isNaN().all();
  if (map.supported[i] > 1)
    throw FileProblem("'supported' is {} at column {}, row {}; it must be 0 or 1", map.supported[i],
                      cell.column, cell.row);
  if (empty && map.supported[i] == 1)
    throw FileProblem("the cell at column {}, row {} counts as supported but has no field", cell.column,
                      cell.row);
  if (!empty && !(mean.allFinite() && variance.allFinite()))
    throw FileProblem("the cell at column {}, row {} lacks some of its field and variance", cell.column,
                      cell.row);
  if (!empty && variance.minCoeff() < 0.0F)
    throw FileProblem("the cell at column {}, row {} has a negative variance", cell.column, cell.row);
}

void check_hyperparameter(const std::string& name, double value) {
  const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_';
  });
  if (!plain)
    throw FileProblem("the hyper-parameter '{}' has a name of other than letters, digits and _", name);
  if (!std::isfinite(value)) throw FileProblem("the hyper-parameter '{}' is {}", name, value);
}

void check_fingerprint(const FieldMap& map, const Fingerprint& f, std::size_t i) {
  if (!f.position_m.allFinite() || !f.field_uT.allFinite() || !std::isfinite(f.heading_rad))
    throw FileProblem("fingerprint {} is not finite", i);
  if (!map.drives.empty() && !(f.session >= 0 && std::cmp_less(f.session, map.drives.size())))
    throw FileProblem("fingerprint {} is of drive {}, but there are {}", i, f.session, map.drives.size());
}

void check_drives(const FieldMap& map) {
  const auto is_drive = [&](int i) { return i >= 0 && std::cmp_less(i, map.drives.size()); };
  for (const SurveyDrive& drive : map.drives)
    if (drive.first > drive.last) throw FileProblem("the drive '{}' ends before it begins", drive.name);
  if (!map.newest_drive.empty() && map.newest_drive.size() != map.geometry.size())
    throw FileProblem("'newest_drive' does not fit the map's cells");
  for (const std::int32_t newest : map.newest_drive)
    if (newest != -1 && !is_drive(newest))
      throw FileProblem("'newest_drive' is {}, but there are {} drives", newest, map.drives.size());
  for (std::size_t i = 0; i < map.replaced.size(); ++i) {
    check_fingerprint(map, map.replaced[i].fingerprint, i);
    if (!is_drive(map.replaced[i].by_session))
      throw FileProblem("replaced fingerprint {} gives drive {} as the cause, but there are {}", i,
                        map.replaced[i].by_session, map.drives.size());
  }
}

}  // namespace

void check_geometry(const GridGeometry& geometry) {
  if (geometry.columns <= 0 || geometry.rows <= 0)
    throw FileProblem("the grid has no cells ({} x {})", geometry.columns, geometry.rows);
  if (geometry.size() > kMaxCells)
    throw FileProblem("the grid has {} x {} cells, more than the {} that a field map may have",
                      geometry.columns, geometry.rows, kMaxCells);
  if (!(geometry.resolution_m > 0.0) || !geometry.map_T_grid.is_finite())
    throw FileProblem("the grid's resolution ({} m) or pose is no positive, finite number",
                      geometry.resolution_m);
  const double extent_m = geometry.resolution_m * std::max(geometry.columns, geometry.rows);
  if (!(extent_m < kMaxExtent_m) || geometry.map_T_grid.position().cwiseAbs().maxCoeff() > kMaxExtent_m)
    throw FileProblem("the grid reaches further than {:g} m", kMaxExtent_m);
}

void check_field_map(const FieldMap& map) {
  check_geometry(map.geometry);
  const std::size_t cells = map.geometry.size();
  if (map.mean_uT.size() != cells || map.variance_uT2.size() != cells || map.supported.size() != cells)
    throw FileProblem("the field map's arrays do not fit its {} x {} cells", map.geometry.columns,
                      map.geometry.rows);
  for (std::size_t i = 0; i < cells; ++i) check_cell(map, i);
  for (std::size_t i = 0; i < map.fingerprints.size(); ++i) check_fingerprint(map, map.fingerprints[i], i);
  check_drives(map);
  for (const auto& [name, value] : map.hyperparameters) check_hyperparameter(name, value);
  if (!std::isfinite(map.height_m)) throw FileProblem("the height of the magnetometer is {}", map.height_m);
}

}  // namespace mstsl::io
