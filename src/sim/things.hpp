#pragma once

#include "mstsl/core/random.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// One thing of a kind, at a spot: no two cars or cupboards are magnetised alike, nor stand quite alike.
Thing make_thing(ThingKind kind, const Pose2& map_T_spot, Random& random);

/// Decides what stands at a spot, from its occupancy.
void settle(Spot& spot, Random& random);

}  // namespace mstsl::sim
