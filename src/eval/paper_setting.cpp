#include "paper_setting.hpp"

#include <utility>

#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/sim/occupancy_map.hpp"

namespace mstsl {
namespace {

enum Stream : std::uint64_t { kWorld = 1, kSurvey, kDay, kWaypoint };

struct AllMaps {
  std::vector<std::shared_ptr<const LocalizationMaps>> by_model;
  std::shared_ptr<const TracedPlace> place;
};

Result<AllMaps> make_maps(const sim::World& world, const std::vector<Fingerprint>& fingerprints,
                          const PaperProtocolOptions& options, Piecework& work) {
  const OccupancyGrid occupancy = sim::occupancy_map(world);
  AllMaps maps;
  for (const FieldModel model : options.models) {
    FieldMapOptions build;
    build.model = model;
    build.analysis.kernel = KernelChoice::kSquaredExponential;  // the paper's Gaussian kernel
    build.threads = options.threads;
    build.progress = [&](double share) { work.tell("field map", share); };
    Result<FieldMap> field = build_field_map(fingerprints, &occupancy, build);
    if (!field) return field.error();
    if (work.stopped()) return Error("interrupted before the first run");
    if (!maps.place)
      maps.place = std::make_shared<const TracedPlace>(TracedPlace{options.world, occupancy, *field});
    auto both = make_localization_maps(occupancy, std::move(field).value(), {.threads = options.threads});
    if (!both) return both.error();
    maps.by_model.push_back(std::move(both).value());
  }
  return maps;
}

}  // namespace

Result<PaperSetting> prepare(const PaperProtocolOptions& options, Piecework& work) {
  const Random random(options.seed);
  Result<sim::World> world = sim::make_world(options.world, {}, random.fork(kWorld));
  if (!world) return world.error();
  work.tell("survey", 0.0);
  SimulatedSurveyOptions survey = options.survey;
  survey.threads = options.threads;
  const auto fingerprints = simulate_survey(*world, survey, random.fork(kSurvey));
  if (!fingerprints) return fingerprints.error();
  auto maps = make_maps(*world, *fingerprints, options, work);
  if (!maps) return maps.error();
  PaperSetting setting{sim::on_another_day(*world, options.moved_fraction, random.fork(kDay)),
                       std::move(maps->by_model),
                       std::move(maps->place),
                       {},
                       fingerprints->size()};
  for (int i = 0; i < options.waypoints; ++i) {
    const auto waypoint = sim::random_waypoint(setting.today, options.run,
                                               random.fork(kWaypoint).fork(static_cast<std::uint64_t>(i)));
    if (!waypoint) return waypoint.error();
    setting.waypoints_m.push_back(*waypoint);
  }
  return setting;
}

}  // namespace mstsl
