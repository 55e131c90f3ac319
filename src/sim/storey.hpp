#pragma once

#include "mstsl/core/random.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// Floor, ceiling, their beams and the trays below the ceiling, corridor by corridor (lane by lane).
void add_storey(WorldPlan& plan, double beam_spacing_m, Random& random);

}  // namespace mstsl::sim
