#include "mstsl/datasets/cea_corridor.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "mstsl/datasets/measured_drive.hpp"
#include "mstsl/datasets/number_columns.hpp"
#include "mstsl/datasets/windows.hpp"
#include "mstsl/sim/occupancy_map.hpp"

namespace mstsl::datasets {
namespace {

constexpr std::uint64_t kSurveyStream = 1;
constexpr std::uint64_t kWindowStream = 2;
constexpr std::uint64_t kRunStream = 3;
constexpr std::uint64_t kCheckStream = 4;

/// Floors are at least this far apart; one floor's rows scatter by 0.7 m in z, so says the data.
constexpr double kFloorHeight_m = 2.0;

Path positions(const std::vector<Fingerprint>& rows) {
  Path path_m;
  for (const Fingerprint& row : rows) path_m.push_back(row.position_m);
  return path_m;
}

std::vector<bool> continued(const Path& path_m, double longest_step_m) {
  std::vector<bool> follows(path_m.size(), false);
  for (std::size_t i = 1; i < path_m.size(); ++i)
    follows[i] = (path_m[i] - path_m[i - 1]).norm() <= longest_step_m;
  return follows;
}

std::string provenance(const CeaCorridorOptions& options, double survey_m, double query_m) {
  return fmt::format(R"(Made from CEA-LIST/large-scale-magnetic-mapping (cea-corridor).

REAL: the magnetic field. survey_00.mcap holds that of floor_a_survey.csv ({:.0f} m), run_*.mcap stretches
of {:.0f} m of floor_a_query.csv ({:.0f} m), another pass through the same corridors: no run holds a
reading of the survey. check_00.mcap holds all of floor_a_query.csv with its positions. The paths are the recorded ones, the heading their direction over {} m. Each run
starts with a random heading and turns in place; while it turns, the field is that of its first row.

SIMULATED: walls (tubes {} m wide around both passes), lidar (UTM-30LX), wheel odometry.
Added to the field: bias of {} uT, noise of {} uT (SD per axis), for its readings hold their own.
)",
                     survey_m, options.runs.length_m, query_m, kHeadingWindow_m, options.corridor.width_m,
                     options.robot.magnetometer.bias_sigma_uT, options.robot.magnetometer.noise_uT);
}

}  // namespace

Result<std::vector<Fingerprint>> read_cea_pass(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 6> kNames = {"x_m", "y_m", "z_m", "bx_uT", "by_uT", "bz_uT"};
  const auto columns = read_number_columns(file, kNames);
  if (!columns) return columns.error();
  const std::vector<double>& z_m = (*columns)[2];
  const auto [lowest, highest] = std::minmax_element(z_m.begin(), z_m.end());
  if (*highest - *lowest > kFloorHeight_m)
    return Error(
        fmt::format("{}: heights from {:.1f} to {:.1f} m are more than one floor; split the file by z_m",
                    file.string(), *lowest, *highest));
  std::vector<Fingerprint> rows(z_m.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].position_m = {(*columns)[0][i], (*columns)[1][i]};
    rows[i].field_uT = {(*columns)[3][i], (*columns)[4][i], (*columns)[5][i]};
  }
  return rows;
}

Result<Dataset> cea_corridor(const std::filesystem::path& folder, const CeaCorridorOptions& options,
                             const Random& random) {
  Result<std::vector<Fingerprint>> survey = read_cea_pass(folder / "floor_a_survey.csv");
  if (!survey) return survey.error();
  const Result<std::vector<Fingerprint>> query = read_cea_pass(folder / "floor_a_query.csv");
  if (!query) return query.error();
  const std::array<Path, 2> paths_m = {positions(*survey), positions(*query)};
  Result<sim::WorldPlan> plan = tube_plan(paths_m, options.corridor);
  if (!plan) return plan.error().within(folder.string());
  const auto world = std::make_shared<const sim::World>(*std::move(plan));

  const auto windows = draw_windows(
      windows_of_length(paths_m[1], continued(paths_m[1], options.longest_step_m), options.runs.length_m),
      options.runs.count, random.fork(kWindowStream));
  if (!windows) return windows.error().within(folder.string());

  Dataset dataset;
  dataset.map = sim::occupancy_map(*world, options.corridor.resolution_m);
  dataset.provenance =
      provenance(options, distances_along(paths_m[0]).back(), distances_along(paths_m[1]).back());
  dataset.surveys.push_back(
      measured_survey(world, *std::move(survey), options.robot, random.fork(kSurveyStream)));
  for (std::size_t i = 0; i < windows->size(); ++i) {
    const auto [first, last] = (*windows)[i];
    const auto begin = query->begin() + static_cast<std::ptrdiff_t>(first);
    std::vector<Fingerprint> rows(begin, begin + static_cast<std::ptrdiff_t>(last - first + 1));
    dataset.runs.push_back(
        measured_run(world, std::move(rows), options.robot, random.fork(kRunStream).fork(i)));
  }
  dataset.checks.push_back(measured_survey(world, *query, options.robot, random.fork(kCheckStream)));
  return dataset;
}

}  // namespace mstsl::datasets
