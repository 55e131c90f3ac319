#pragma once

#include <memory>
#include <span>

#include "mstsl/core/random.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/datasets/corrected_track.hpp"
#include "mstsl/datasets/dataset.hpp"
#include "mstsl/sim/robot.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::datasets {

/// A recorded drive, between two times of it, with a magnetometer added.
struct TrackPart {
  std::shared_ptr<const CorrectedTrack> track;
  Stamp from;
  Stamp to;
};

/// The real odometry (with a reading added at each scan, between the recorded ones) and scans of that time,
/// and readings of a simulated magnetometer along the track, in time order (at one time odometry, then field,
/// then scan). The truth is told at every odometry and every scan; a survey may have no scans.
Log track_log(const TrackPart& part, std::span<const OdometryReading> odometry,
              std::span<const LaserScan> scans, std::shared_ptr<const sim::World> world, const Rig& rig,
              const sim::MagnetometerOptions& magnetometer, const Random& random);

}  // namespace mstsl::datasets
