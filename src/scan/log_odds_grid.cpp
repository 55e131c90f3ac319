#include "mstsl/scan/log_odds_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "mstsl/grid/frame.hpp"
#include "mstsl/grid/ray.hpp"

namespace mstsl {
namespace {

double to_log_odds(double probability) { return std::log(probability / (1.0 - probability)); }

/// A beam in cells of the grid, cut at the longest range.
struct GridBeam {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  std::optional<Cell> hit;
};

std::vector<GridBeam> beams_on_grid(const std::vector<BeamReturn>& returns_base, const Pose2& map_T_base,
                                    const GridFrame& frame, double max_range_m) {
  const Eigen::Matrix2d rotation = map_T_base.rotation();
  const auto to_grid = [&](const Eigen::Vector2d& p) {
    return frame.to_grid(rotation * p + map_T_base.position());
  };
  std::vector<GridBeam> beams;
  beams.reserve(returns_base.size());
  for (const BeamReturn& r : returns_base) {
    const double range_m = (r.point_m - r.origin_m).norm();
    GridBeam beam{to_grid(r.origin_m), to_grid(r.point_m), std::nullopt};
    if (!beam.from.allFinite() || !beam.to.allFinite()) continue;
    if (range_m > max_range_m) {
      beam.to = beam.from + max_range_m / range_m * (beam.to - beam.from);
    } else {
      beam.hit = GridFrame::cell_of(beam.to);
    }
    beams.push_back(beam);
  }
  return beams;
}

}  // namespace

LogOddsGrid::LogOddsGrid(const GridGeometry& geometry, const BeamModel& model)
    : model_(model), values_(geometry), drawn_in_(geometry) {}

void LogOddsGrid::add(Cell cell, double log_odds) {
  if (!values_.contains(cell) || drawn_in_[cell] == scan_) return;
  drawn_in_[cell] = scan_;
  values_[cell] =
      static_cast<float>(std::clamp(values_[cell] + log_odds, -model_.limit_log_odds, model_.limit_log_odds));
}

void LogOddsGrid::draw(const std::vector<BeamReturn>& returns_base, const Pose2& map_T_base) {
  ++scan_;
  const std::vector<GridBeam> beams =
      beams_on_grid(returns_base, map_T_base, GridFrame(geometry()), model_.max_range_m);
  for (const GridBeam& beam : beams) {
    if (beam.hit) add(*beam.hit, model_.hit_log_odds);
  }
  for (const GridBeam& beam : beams) {
    walk_grid(geometry(), beam.from, beam.to, [&](Cell cell, double) {
      if (cell != beam.hit) add(cell, model_.miss_log_odds);
      return true;
    });
  }
}

LogOddsGrid LogOddsGrid::moved_to(const GridGeometry& geometry) const {
  LogOddsGrid moved(geometry, model_);
  moved.scan_ = scan_;
  const Eigen::Vector2d origin = geometry.to_grid(values_.geometry().to_map(Eigen::Vector2d::Zero()));
  const int right = static_cast<int>(std::lround(origin.x())), up = static_cast<int>(std::lround(origin.y()));
  for (std::size_t i = 0; i < values_.values().size(); ++i) {
    const Cell here = values_.geometry().cell(i), there{here.column + right, here.row + up};
    if (moved.values_.contains(there)) moved.values_[there] = values_.values()[i];
  }
  return moved;
}

OccupancyGrid LogOddsGrid::occupancy(double occupied_probability, double free_probability) const {
  const double occupied = to_log_odds(occupied_probability), free = to_log_odds(free_probability);
  OccupancyGrid states(geometry(), CellState::kUnknown);
  for (std::size_t i = 0; i < states.values().size(); ++i) {
    const float belief = values_.values()[i];
    if (belief > occupied) states.values()[i] = CellState::kOccupied;
    if (belief < free) states.values()[i] = CellState::kFree;
  }
  return states;
}

}  // namespace mstsl
