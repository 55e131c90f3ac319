#pragma once

#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/hard_report.hpp"
#include "mstsl/eval/paper_protocol.hpp"
#include "mstsl/eval/run_trace.hpp"

namespace mstsl::report {

/// What a report shows; whatever is empty is left out.
struct Page {
  std::string title;
  std::string subtitle;
  std::string summary_json;     ///< tables and curves of a protocol, as hard_summary() gives them
  std::vector<RunTrace> runs;   ///< to be replayed; each must have a place
  std::string paper_json = {};  ///< the paper's tables and curves, as paper_summary() gives them
};

/// The page as one HTML file that needs neither server nor network: style, program and data are in it. Runs
/// are deflated and unpacked one by one as they are looked at. The same bytes for the same content.
std::string html(const Page& page);

/// The tables of hard_json() and hard_cost_json(), and the curves behind them: for each method the ways to
/// the first right pose (m, ascending), the errors of later poses (m, 0 to 100 % in 201 steps), and the
/// reliability of first poses.
std::string hard_summary(const std::vector<HardRecord>& records, const HardHead& head);

/// The paper's Table I, success by waypoint, ways to the first right pose and errors of first poses.
std::string paper_summary(const ProtocolResult& result);

}  // namespace mstsl::report
