#pragma once

#include <filesystem>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/paper_protocol.hpp"

namespace mstsl::app {

/// The paper's Figures 4, 5 and 6 of one world, as SVG: fig4 a case with the hypotheses that were rejected
/// and the one that survived, fig5 the field over the map with the waypoints, fig6a to c success by waypoint,
/// CLD, and the distribution of the first pose's error.
Result<void> draw_paper_figures(const ProtocolResult& result, const std::filesystem::path& folder);

}  // namespace mstsl::app
