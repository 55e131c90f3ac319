#pragma once

#include <Eigen/Core>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/sim/world.hpp"

/// Plans of the built-in worlds, spots not yet settled. Each stands around the map's origin, its long side
/// along x.
namespace mstsl::sim {

WorldPlan plan_corridor(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);
WorldPlan plan_carpark(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);
WorldPlan plan_warehouse(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);
WorldPlan plan_office_wing(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);

/// The corridor with walls exactly symmetric under 180 deg and nothing visible standing about.
WorldPlan plan_symmetric_loop(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);
WorldPlan plan_aisles(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);
WorldPlan plan_pillar_hall(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);
WorldPlan plan_h_wing(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);
WorldPlan plan_office(const WorldOptions& options, const Eigen::Vector2d& size_m, Random& random);

/// Random streams that a world's making is split into: what stands about never changes the walls or their
/// steel.
enum WorldStream : std::uint64_t { kBuildingStream = 1, kThingsStream = 2 };

}  // namespace mstsl::sim
