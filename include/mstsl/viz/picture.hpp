#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/pose2.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/magnetic/field_map.hpp"
#include "mstsl/viz/canvas.hpp"

namespace mstsl::viz {

/// What of the field the colours show: its length, one component (map frame), or the standard deviation, all
/// in uT.
enum class FieldQuantity { kNorm, kX, kY, kZ, kDeviation };

/// A place where the robot may have been.
struct HypothesisMark {
  Pose2 map_T_base;
  double weight = 0.0;    ///< 0 to 1
  bool rejected = false;  ///< drawn pale and hollow
};

/// A place with a word to it, such as a start.
struct PlaceLabel {
  Eigen::Vector2d place_m;
  std::string words;
};

/// What a picture of a localization run shows; whatever is empty is left out, of the legend too.
struct RunPicture {
  std::string title;
  std::string subtitle;
  const FieldMap* field =
      nullptr;  ///< not owned; shown where the map is free, pale where no fingerprint supports it
  FieldQuantity quantity = FieldQuantity::kNorm;
  std::vector<Pose2> true_path;
  std::vector<Pose2> estimated_path;  ///< where two poses lie over a metre apart the line is broken
  std::vector<HypothesisMark> hypotheses;
  std::optional<Pose2> start;
  std::vector<PlaceLabel> places;
  std::vector<Eigen::Vector2d> scan_points_m;  ///< the points of one scan, map frame
};

/// Draws a run over its map, cropped to what is known: field colours with a bar, paths, hypotheses, a scale
/// bar in m.
Canvas draw_run(const OccupancyGrid& map, const RunPicture& run, double width_px = 1600.0);

}  // namespace mstsl::viz
