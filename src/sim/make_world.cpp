#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "mstsl/sim/world.hpp"

#include "built_in_worlds.hpp"
#include "things.hpp"

namespace mstsl::sim {
namespace {

struct Kind {
  std::string_view name;
  Eigen::Vector2d default_m, least_m;
  WorldPlan (*plan)(const WorldOptions&, const Eigen::Vector2d&, Random&);
};

/// Sizes: the corridor after the real loop, the others as the buildings they stand for commonly are.
const std::array<Kind, 9> kKinds{{{"corridor", {60, 26}, {30, 16}, plan_corridor},
                                  {"carpark", {70, 40}, {36, 24}, plan_carpark},
                                  {"warehouse", {60, 40}, {18, 20}, plan_warehouse},
                                  {"office-wing", {54, 13}, {15, 9}, plan_office_wing},
                                  {"symmetric-loop", {60, 26}, {30, 16}, plan_symmetric_loop},
                                  {"aisles", {42, 30}, {16, 16}, plan_aisles},
                                  {"pillar-hall", {36, 30}, {18, 18}, plan_pillar_hall},
                                  {"h-wing", {44, 40}, {16, 16}, plan_h_wing},
                                  {"office", {44, 13}, {16, 9}, plan_office}}};

std::string known_names() {
  std::string list;
  for (const Kind& kind : kKinds) list += (list.empty() ? "" : ", ") + std::string(kind.name);
  return list;
}

}  // namespace

std::vector<std::string> world_names() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

Result<World> make_world(std::string_view name, const WorldOptions& options, const Random& random) {
  for (const Kind& kind : kKinds) {
    if (kind.name != name) continue;
    const bool given = options.size_m.x() > 0 && options.size_m.y() > 0;
    const Eigen::Vector2d size = given ? options.size_m : kind.default_m;
    constexpr double kLargest_m = 500.0;
    if ((size.array() < kind.least_m.array()).any() || (size.array() > kLargest_m).any())
      return Error("world '" + std::string(name) + "' cannot be built in this size; give it at least " +
                   std::to_string(static_cast<int>(kind.least_m.x())) + " x " +
                   std::to_string(static_cast<int>(kind.least_m.y())) + " m and at most 500 x 500 m");
    Random building = random.fork(kBuildingStream);
    WorldPlan plan = kind.plan(options, size, building);
    plan.earth = options.earth;
    plan.magnetisation = options.magnetisation;
    const Random things = random.fork(kThingsStream);
    for (std::size_t i = 0; i < plan.spots.size(); ++i) {
      Random own = things.fork(i);
      settle(plan.spots[i], own);
    }
    return World(std::move(plan));
  }
  return Error("there is no world '" + std::string(name) + "'; choose one of " + known_names());
}

}  // namespace mstsl::sim
