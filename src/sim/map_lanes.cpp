#include "map_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <iterator>

#include <Eigen/Geometry>

#include "mstsl/core/angles.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;

constexpr double kStation_m = 0.2;  ///< between cuts
constexpr double kSample_m = 0.1;   ///< along a cut
constexpr double kRobot_m = 0.35;   ///< room that the robot's centre needs on every side
constexpr double kAligned_m = 0.3;  ///< middles of neighbouring cuts that belong together
constexpr double kBridge_m = 4.0;   ///< a crossing may interrupt a lane for this long
constexpr double kShortest_m = 3.0;
constexpr double kWallNear_m = kRobot_m + 0.15;
constexpr double kWalledShare =
    0.5;  ///< of a lane's cuts; beams that left through a window make free fans, not lanes
constexpr double kStraight_m = 0.15;  ///< a lane's middles lie within this of a straight line

/// The reachable part of a cut: from low to high across, at a station.
struct Cut {
  double station_m, low_m, high_m;
  bool walled = false;  ///< surfaces, not unknown ground, end it on both sides
  double middle() const { return 0.5 * (low_m + high_m); }
  double width() const { return high_m - low_m; }
};

using Chain = std::vector<Cut>;

bool has_room(const OccupancyGrid& map, const SegmentIndex& walls, const Vector2d& at_m) {
  if (state_at(map, at_m) != CellState::kFree) return false;
  for (int i = 0; i < 8; ++i) {  // unknown ground is no ground
    const double angle = i * radians(45.0);
    if (state_at(map, at_m + kRobot_m * Vector2d(std::cos(angle), std::sin(angle))) != CellState::kFree)
      return false;
  }
  return walls.clearance(at_m, kRobot_m) >= kRobot_m;
}

Eigen::AlignedBox2d extent_along(const GridGeometry& geometry, const Pose2& axis_T_map) {
  Eigen::AlignedBox2d extent;
  for (const double x : {0.0, static_cast<double>(geometry.columns)})
    for (const double y : {0.0, static_cast<double>(geometry.rows)})
      extent.extend(axis_T_map * geometry.to_map({x, y}));
  return extent;
}

bool continues(const Chain& chain, const Cut& cut, const SegmentIndex& walls, const Pose2& map_T_axis) {
  const Cut& last = chain.back();
  const double gap = cut.station_m - last.station_m;
  if (gap > kBridge_m || std::abs(cut.middle() - last.middle()) > kAligned_m) return false;
  if (std::abs(cut.width() - last.width()) > 0.3 * std::max(1.0, last.width())) return false;
  return !walls.blocked(map_T_axis * Vector2d(last.station_m, last.middle()),
                        map_T_axis * Vector2d(cut.station_m, cut.middle()));
}

std::vector<Cut> cuts_at(double station_m, const Eigen::AlignedBox2d& extent, const OccupancyGrid& map,
                         const SegmentIndex& walls, const Pose2& map_T_axis) {
  const auto is_walled = [&](const Cut& cut) {
    return walls.clearance(map_T_axis * Vector2d(station_m, cut.low_m), kWallNear_m) < kWallNear_m &&
           walls.clearance(map_T_axis * Vector2d(station_m, cut.high_m), kWallNear_m) < kWallNear_m;
  };
  std::vector<Cut> cuts;
  bool inside = false;
  for (double across = extent.min().y(); across <= extent.max().y(); across += kSample_m) {
    const bool room = has_room(map, walls, map_T_axis * Vector2d(station_m, across));
    if (room && !inside) cuts.push_back({station_m, across, across});
    if (room) cuts.back().high_m = across;
    inside = room;
  }
  for (Cut& cut : cuts) cut.walled = is_walled(cut);
  return cuts;
}

/// Splits a chain where its middles leave the straight line from end to end.
void add_straight(const Chain& chain, std::size_t first, std::size_t last, const Pose2& map_T_axis,
                  std::vector<Lane>& lanes) {
  const Segment line{{chain[first].station_m, chain[first].middle()},
                     {chain[last].station_m, chain[last].middle()}};
  if (length(line) < kShortest_m) return;
  std::size_t worst = first;
  double worst_m = kStraight_m;
  for (std::size_t i = first; i <= last; ++i) {
    const double away = distance({chain[i].station_m, chain[i].middle()}, line);
    if (away > worst_m) worst_m = away, worst = i;
  }
  if (worst != first) {
    add_straight(chain, first, worst, map_T_axis, lanes);
    add_straight(chain, worst, last, map_T_axis, lanes);
    return;
  }
  std::vector<double> widths;
  double walled = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    widths.push_back(chain[i].width());
    walled += chain[i].walled ? 1.0 : 0.0;
  }
  if (walled < kWalledShare * static_cast<double>(widths.size())) return;
  std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2),
                   widths.end());
  const double width = widths[widths.size() / 2];
  if (length(line) >= width) lanes.push_back({map_T_axis * line, width + 2.0 * kRobot_m});
}

void add_lanes_along(const Pose2& map_T_axis, const OccupancyGrid& map, const SegmentIndex& walls,
                     std::vector<Lane>& lanes) {
  const Eigen::AlignedBox2d extent = extent_along(map.geometry(), inverse(map_T_axis));
  std::vector<Chain> open, closed;
  for (double station = extent.min().x(); station <= extent.max().x(); station += kStation_m) {
    for (const Cut& cut : cuts_at(station, extent, map, walls, map_T_axis)) {
      const auto chain = std::find_if(open.begin(), open.end(), [&](const Chain& c) {
        return c.back().station_m < station && continues(c, cut, walls, map_T_axis);
      });
      if (chain != open.end())
        chain->push_back(cut);
      else
        open.push_back({cut});
    }
    const auto is_over = [&](const Chain& c) { return station - c.back().station_m > kBridge_m; };
    std::copy_if(open.begin(), open.end(), std::back_inserter(closed), is_over);
    std::erase_if(open, is_over);
  }
  closed.insert(closed.end(), open.begin(), open.end());
  for (const Chain& chain : closed) add_straight(chain, 0, chain.size() - 1, map_T_axis, lanes);
}

}  // namespace

double main_direction(const std::vector<Segment>& walls) {
  std::complex<double> sum;
  for (const Segment& wall : walls) {
    const Vector2d along = wall.b - wall.a;
    sum += std::polar(along.norm(), 4.0 * std::atan2(along.y(), along.x()));
  }
  return 0.25 * std::arg(sum);
}

std::vector<Lane> lanes_of_map(const OccupancyGrid& map, const SegmentIndex& walls, double axis_yaw_rad) {
  std::vector<Lane> lanes;
  for (const double turn : {0.0, radians(90.0)})
    add_lanes_along({0, 0, axis_yaw_rad + turn}, map, walls, lanes);
  return lanes;
}

}  // namespace mstsl::sim
