#pragma once

#include <cstddef>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/sim/route.hpp"
#include "mstsl/sim/world.hpp"

namespace mstsl::sim {

/// How the lanes are driven to collect fingerprints. Each line is driven both ways, so body x lies along 0
/// and 180 deg (or +-90 deg) of the building's axis, as in section III-A.2 of the paper.
struct SurveyOptions {
  double lane_spacing_m = 0.5;  ///< between neighbouring lines of one lane
  double edge_margin_m = 0.4;   ///< the outermost line stays this far inside the free width
  int passes = 1;               ///< how often each line is driven both ways
  std::size_t fingerprints =
      0;  ///< if not 0: as many passes (or as few lines) as give this many fingerprints
  double fingerprint_spacing_m = 0.05;  ///< one fingerprint per this much travel (paper: 5 cm)
  PathOptions path;                     ///< nearer to a surface than this no line is driven
  double log_length_m = 1500.0;         ///< a log ends after about this much driving: a battery's charge
};

/// The survey's routes, one a log; together they pass every lane. Errors: fewer fingerprints wished for than
/// one line per lane gives, or lanes that no path connects.
Result<std::vector<Route>> survey_routes(const World& world, const SurveyOptions& options);

}  // namespace mstsl::sim
