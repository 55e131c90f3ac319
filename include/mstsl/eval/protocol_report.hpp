#pragma once

#include <string>

#include "mstsl/eval/paper_protocol.hpp"

namespace mstsl {

/// Table I, success by waypoint (Fig. 6 a, d), CLD (b, e) and error CDF (c, f) of one world as text, with the
/// paper's own figures beside ours.
std::string protocol_text(const ProtocolResult& result);

/// All of it as one JSON object: by model the summary, success by waypoint, CDF, and the paper's figures.
std::string protocol_json(const ProtocolResult& result);

/// One line a run and model: what protocol_text() sums up.
std::string protocol_runs_csv(const ProtocolResult& result);

/// The share of runs with a first pose no farther off than each error, a column a model.
std::string protocol_cdf_csv(const ProtocolResult& result);

}  // namespace mstsl
