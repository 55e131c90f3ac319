#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "mstsl/core/pose2.hpp"

namespace mstsl::io::carmen {

/// ODOM x y theta tv rv accel t host t: in m and rad, t in s.
struct OdometryLine {
  Pose2 pose;
  double time_s = 0.0;
};

/// FLASER n r1 .. rn x y theta ox oy otheta t host t.
struct ScanLine {
  std::vector<float> ranges_m;
  Pose2 pose;      ///< x y theta: corrected by the log's authors, or, in a raw log, by odometry
  Pose2 odometry;  ///< ox oy otheta
  double time_s = 0.0;
};

struct OtherLine {};    ///< a comment, a parameter, another kind of message
struct DamagedLine {};  ///< begins like one of ours but does not go on like it

using Line = std::variant<OtherLine, DamagedLine, OdometryLine, ScanLine>;

Line parse_line(std::string_view line);

/// Whether a line begins as only a line of a CARMEN log does.
bool is_typical(std::string_view line);

}  // namespace mstsl::io::carmen
