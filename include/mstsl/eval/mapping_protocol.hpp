#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mstsl/core/crew.hpp"
#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"

namespace mstsl {

/// The robots that drive: "good" has a laser that sees 30 m over 270 deg (UTM-30LX) and wheels of 3 % and 1
/// deg/m; "cheap" one of 8 m, one beam a degree, 5.5 Hz, 2 cm of noise (the class of an RPLIDAR A1) and
/// wheels of 6 % and 2 deg/m.
std::vector<std::string> mapping_robot_names();

/// Drives through simulated buildings, mapped by scans alone and by scans and field.
struct MappingProtocolOptions {
  std::vector<std::string> worlds{"symmetric-loop", "h-wing", "office-wing", "warehouse", "corridor"};
  std::vector<std::string> robots = mapping_robot_names();
  int runs = 20;  ///< of each world, each with other steel and another way, the same for every robot
  double length_m = 400.0;  ///< driven per run
  std::uint64_t seed = 1;
  Threads threads;
  Crew crew;  ///< the processes that share the drives
  /// Finished drives are kept here and taken up again by the same `build`; nothing is kept where it is empty.
  std::filesystem::path folder;
  std::string build;                           ///< of the program
  std::function<bool(double share)> progress;  ///< false ends it
};

/// One drive, mapped one way.
struct MappingRecord {
  std::string world, robot;
  int run = 0;
  bool with_field = false;
  double driven_m = 0.0;
  std::size_t closures = 0;
  std::size_t wrong_closures = 0;  ///< off by more than half a metre or 10 deg, and not refuted
  std::size_t refuted = 0;         ///< wrong or not
  std::size_t ambiguous = 0, refused_by_field = 0, closed_only_with_field = 0;
  double ate_rms_m = 0.0, ate_max_m = 0.0;
  double map_error = 0.0;  ///< share of the map's walls that lie more than 0.2 m from a true surface
  double cpu_s = 0.0;
  double driven_s = 0.0;
};

/// Errors: a world or robot that is not there, a world that cannot be toured, an end asked for.
Result<std::vector<MappingRecord>> run_mapping_protocol(const MappingProtocolOptions& options);

/// The records as a table for people, and as JSON.
std::string mapping_text(std::span<const MappingRecord> records);
std::string mapping_json(std::span<const MappingRecord> records, const MappingProtocolOptions& options,
                         const std::string& commit);

}  // namespace mstsl
