#include "hard_building.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mstsl/eval/simulated_survey.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/sim/occupancy_map.hpp"

namespace mstsl {
namespace {

enum Stream : std::uint64_t { kWorld = 1, kSurvey };
constexpr double kWeakest_uT = 3.0;  // issue: field SD down to 3 uT

Result<FieldMap> survey(const HardBuilding& building, const OccupancyGrid& occupancy, const SurveyKind& kind,
                        const Random& random, Threads threads) {
  SimulatedSurveyOptions options;
  options.threads = threads;
  options.survey.lane_spacing_m = kind.sparse ? 1.0 : 0.5;
  options.field = weakened(building.surveyed, building.steel_share);
  const auto fingerprints = simulate_survey(building.surveyed, options, random.fork(kSurvey));
  if (!fingerprints) return fingerprints.error();
  FieldMapOptions build;
  build.threads = threads;
  return build_field_map(*fingerprints, &occupancy, build);
}

}  // namespace

std::string SurveyKind::name() const {
  return fmt::format("{}-{}", weak_field ? "weak" : "full", sparse ? "sparse" : "dense");
}

sim::FieldSource weakened(const sim::World& world, double steel_share) {
  if (steel_share >= 1.0) return {};
  return [&world, steel_share, earth = world.field().earth().in_map_uT()](
             const Pose2&, const Eigen::Vector3d& position_m) -> Eigen::Vector3d {
    return earth + steel_share * (world.field_uT(position_m) - earth);
  };
}

double field_spread_uT(const sim::World& world) {
  constexpr double kStep_m = 0.3, kHeight_m = 0.7;
  std::vector<Eigen::Vector3d> readings;
  for (const sim::Lane& lane : world.lanes())
    for (double along = 0; along <= length(lane.center); along += kStep_m) {
      const Eigen::Vector2d at = point_along(lane.center, along / length(lane.center));
      readings.push_back(world.field_uT({at.x(), at.y(), kHeight_m}));
    }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& reading : readings) mean += reading / static_cast<double>(readings.size());
  double squares = 0.0;
  for (const Eigen::Vector3d& reading : readings) squares += (reading - mean).squaredNorm();
  return std::sqrt(squares / (3.0 * static_cast<double>(std::max<std::size_t>(1, readings.size()))));
}

Result<HardBuilding> make_building(const std::string& world, const SurveyKind& kind, const Random& random,
                                   const std::filesystem::path& folder, const std::string& name,
                                   Threads threads) {
  Result<sim::World> made = sim::make_world(world, {}, random.fork(kWorld));
  if (!made) return made.error();
  HardBuilding building{std::move(made).value(), 1.0, {}};
  if (kind.weak_field) building.steel_share = std::min(1.0, kWeakest_uT / field_spread_uT(building.surveyed));
  const OccupancyGrid occupancy = sim::occupancy_map(building.surveyed);

  const std::filesystem::path file = folder / (name + ".nc");
  const bool kept = std::filesystem::exists(file);
  Result<FieldMap> field =
      kept ? io::read_field_map(file) : survey(building, occupancy, kind, random, threads);
  if (!field) return field.error().within(fmt::format("the survey of {}", name));
  if (!kept)
    if (const Result<void> written = io::write_field_map(*field, file); !written) return written.error();
  auto maps = make_localization_maps(occupancy, std::move(field).value(), {.threads = threads});
  if (!maps) return maps.error().within(fmt::format("the maps of {}", name));
  building.maps = std::move(maps).value();
  return building;
}

}  // namespace mstsl
