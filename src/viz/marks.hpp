#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "mstsl/viz/canvas.hpp"
#include "mstsl/viz/picture.hpp"

#include "map_view.hpp"

/// The signs of a run's picture. Angles here are those of the sheet: clockwise from the right.
namespace mstsl::viz {

void draw_scan_point(Canvas& canvas, const Eigen::Vector2d& at);
void draw_true_line(Canvas& canvas, const Points& points);
void draw_estimated_line(Canvas& canvas, const Points& points);
void draw_true_path(Canvas& canvas, const MapView& view, const std::vector<Pose2>& path);
void draw_estimated_path(Canvas& canvas, const MapView& view, const std::vector<Pose2>& path);

/// An arrow head at a hypothesis; `weight` relative to the best makes it more or less opaque.
void draw_hypothesis(Canvas& canvas, const Eigen::Vector2d& at, double angle, double weight, bool rejected);
void draw_hypotheses(Canvas& canvas, const MapView& view, const std::vector<HypothesisMark>& marks);

/// A disc with a word beside it.
void draw_place(Canvas& canvas, const Eigen::Vector2d& at, const std::string& words);

void draw_start(Canvas& canvas, const Eigen::Vector2d& at, double angle);
void draw_robot(Canvas& canvas, const Eigen::Vector2d& at, double angle);

}  // namespace mstsl::viz
