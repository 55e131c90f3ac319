#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mstsl/eval/paper_protocol.hpp"

#include "session.hpp"

namespace CLI {
class App;
}

namespace mstsl::app {

/// What a user may ask of `bench --protocol paper`.
struct PaperWish {
  std::string world = "both";
  std::vector<std::string> models{"gpr", "bilinear", "fingerprint"};
  int waypoints = PaperProtocolOptions{}.waypoints;
  std::optional<std::size_t> fingerprints;  ///< the paper's, if absent
  double lane_spacing_m = sim::SurveyOptions{}.lane_spacing_m;
  double bias_uT = sim::MagnetometerOptions{}.bias_sigma_uT;
  double moved = PaperProtocolOptions{}.moved_fraction;
  std::optional<std::size_t> hypotheses;
};

void add_paper_options(CLI::App& command, PaperWish& wish);

/// Runs it and writes report, tables, figures and results into `folder`.
Result<Exit> bench_paper(const Session& session, const PaperWish& wish, int runs,
                         const std::filesystem::path& folder);

}  // namespace mstsl::app
