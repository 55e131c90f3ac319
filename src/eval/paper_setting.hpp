#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "mstsl/eval/paper_protocol.hpp"

#include "piecework.hpp"

namespace mstsl {

/// Everything that all runs of the paper's experiment share.
struct PaperSetting {
  sim::World today;
  std::vector<std::shared_ptr<const LocalizationMaps>> maps;  ///< by model
  std::shared_ptr<const TracedPlace> place;
  std::vector<Eigen::Vector2d> waypoints_m;
  std::size_t fingerprints = 0;
};

/// Builds the world, surveys it, makes a map of each model, moves some things and draws the waypoints.
/// Errors: a world that is not there, a survey or map that cannot be made, an end asked for.
Result<PaperSetting> prepare(const PaperProtocolOptions& options, Piecework& work);

}  // namespace mstsl
