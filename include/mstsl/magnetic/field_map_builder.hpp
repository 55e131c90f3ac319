#pragma once

#include <functional>
#include <optional>
#include <span>

#include "mstsl/core/parallel.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/magnetic/fingerprint.hpp"
#include "mstsl/magnetic/hyperparameters.hpp"

namespace mstsl {

struct FieldMapOptions {
  FieldModel model = FieldModel::kGpr;
  /// Side of a cell, in m (paper section III-A.2: 5 cm).
  double resolution_m = 0.05;
  /// Cells further than this from every fingerprint, in m, get no value, unless they are free in the
  /// occupancy grid.
  double reach_m = 2.0;
  /// What the GPR assumes; learned from the fingerprints where absent.
  std::optional<FieldHyperparameters> hyperparameters;
  /// Distance of the bilinear model's lattice nodes, in m; taken from the distance of the lanes where absent.
  std::optional<double> bilinear_spacing_m;
  Threads threads;
  /// Called now and then with the share of the work that is done, from one thread at a time.
  std::function<void(double)> progress;
};

/// The field on cells of 5 cm from a survey's fingerprints, by the model asked for. With an occupancy grid
/// the cells lie along its axes and its free cells all get a value (the prior's where no fingerprint is
/// near). Errors: too few fingerprints, values that are not finite, a place too large for memory.
Result<FieldMap> build_field_map(std::span<const Fingerprint> fingerprints, const OccupancyGrid* area,
                                 const FieldMapOptions& options = {});

}  // namespace mstsl
