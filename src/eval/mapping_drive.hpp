#pragma once

#include <string>
#include <vector>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/eval/mapping_protocol.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl {

/// What the sensors said on a drive, and the truth.
struct Recording {
  Rig rig;
  std::vector<SensorEvent> events;
  Trajectory truth;
};

/// A robot of mapping_robot_names() drives from place to place. Errors: a robot that is not there, a world
/// that cannot be toured.
Result<Recording> record_drive(const sim::World& world, const std::string& robot,
                               const MappingProtocolOptions& options, const Random& random);

}  // namespace mstsl
