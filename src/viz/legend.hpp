#pragma once

#include <Eigen/Geometry>

#include "mstsl/viz/canvas.hpp"
#include "mstsl/viz/picture.hpp"

namespace mstsl::viz {

/// Explains the signs that the run's picture holds, row by row within a frame.
void draw_legend(Canvas& canvas, const RunPicture& run, const Eigen::AlignedBox2d& frame);

}  // namespace mstsl::viz
