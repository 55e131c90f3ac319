#pragma once

#include <filesystem>
#include <functional>

#include "mstsl/core/result.hpp"
#include "mstsl/datasets/dataset.hpp"

namespace mstsl::datasets {

/// Writes map.yaml with its image, survey_NN.mcap with the true poses on /ground_truth, run_NN.mcap and,
/// apart from it, truth_NN.csv, and README.txt, into a folder that is made if need be. `progress` is told the
/// share that is done and may return false to stop. Errors: a full disk; a folder with logs of another
/// conversion that this one would not replace; a stop.
Result<void> write_dataset(const Dataset& dataset, const std::filesystem::path& folder,
                           const std::function<bool(double)>& progress = {});

}  // namespace mstsl::datasets
