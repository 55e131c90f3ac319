#pragma once

#include <deque>
#include <vector>

#include "mstsl/core/pose2.hpp"
#include "mstsl/scan/scanned_walls.hpp"

namespace mstsl {

/// The walls that the scans of the last metres showed, wherever the robot goes.
class RecentWalls {
 public:
  explicit RecentWalls(double recent_m, const ScannedWallsOptions& options = {});

  /// Adds a scan, taken where the robot came next.
  void add(const std::vector<FacedPoint>& points_base_m, const Pose2& chain_T_base);

  const ScannedWalls& walls() const { return walls_; }

 private:
  struct Drawn {
    std::vector<FacedPoint> points_base_m;
    Pose2 chain_T_base;
    double travelled_m;
  };
  double recent_m_;
  ScannedWallsOptions options_;
  ScannedWalls walls_;
  std::deque<Drawn> drawn_;
  std::size_t drawn_since_ = 0;  ///< scans since the walls were begun anew
};

}  // namespace mstsl
