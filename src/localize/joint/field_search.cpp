#include "mstsl/localize/joint/field_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "kalman.hpp"

namespace mstsl::joint {
namespace {

/// What a station is for one heading of the base: where its magnetometer was, and how its axes lay.
struct Turned {
  Eigen::Vector2d offset_m;
  Eigen::Matrix3d sensor_R_map;
  Eigen::Vector3d field_uT;
};

std::vector<Station> thinned_way(std::span<const Station> way, double every_m, std::size_t most) {
  std::vector<Station> kept;
  for (auto station = way.rbegin(); station != way.rend() && kept.size() < most; ++station)
    if (kept.empty() || distance(kept.back().base_T_then, station->base_T_then) >= every_m)
      kept.push_back(*station);
  return kept;
}

std::vector<Turned> turned(const std::vector<Station>& way, double yaw_rad,
                           const Eigen::Vector2d& magnetometer_m) {
  std::vector<Turned> stations;
  for (const Station& station : way) {
    const Pose2 then = Pose2{0, 0, yaw_rad} * station.base_T_then;
    stations.push_back({then * magnetometer_m, about_z(then.yaw).transpose(), station.base_field_uT});
  }
  return stations;
}

/// Log density of the stations at a place, the bias integrated out, but for a constant.
double log_density(const std::vector<Turned>& way, const Eigen::Vector2d& place_m, const FieldSampler& field,
                   const FieldModel& model) {
  double weights = 0.0, squares = 0.0, logs = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Turned& station : way) {
    const FieldSampler::Sample here = field.sample(place_m + station.offset_m);
    const double claimed = here.variance_uT2.mean() * (here.known ? square(model.map_error_factor) : 1.0);
    const double variance = claimed + square(model.map_error_floor_uT);
    const Eigen::Vector3d off = station.field_uT - station.sensor_R_map * here.mean_uT;
    weights += 1.0 / variance;
    sum += off / variance;
    squares += off.squaredNorm() / variance;
    logs += std::log(variance);
  }
  const double bias = square(model.bias_sigma_uT);
  return -0.5 * (squares - sum.squaredNorm() * bias / (1.0 + weights * bias) + 3.0 * logs +
                 3.0 * std::log1p(weights * bias));
}

struct Found {
  double log_density = -std::numeric_limits<double>::infinity();
  Pose2 map_T_base;
};

}  // namespace

FieldSearch::FieldSearch(const OccupancyGrid& occupancy, const FieldSearchOptions& options)
    : options_(options) {
  const GridGeometry& g = occupancy.geometry();
  const int side = std::max(1, static_cast<int>(std::lround(options.step_m / g.resolution_m)));
  for (int row = side / 2; row < g.rows; row += side)
    for (int column = side / 2; column < g.columns; column += side)
      if (occupancy[Cell{column, row}] == CellState::kFree)
        places_m_.push_back(g.center_of(Cell{column, row}));
}

std::vector<Pose2> FieldSearch::find(std::span<const Station> way, const FieldSampler& field,
                                     const Eigen::Vector2d& magnetometer_m, const FieldModel& model,
                                     Threads threads) const {
  const std::vector<Station> stations = thinned_way(way, options_.stations_every_m, options_.max_stations);
  const auto headings = static_cast<std::size_t>(std::ceil(2 * kPi / options_.turn_rad));
  std::vector<std::vector<Found>> by_heading(headings);
  parallel_for(headings, threads, [&](std::size_t h) {
    const double yaw_rad = 2 * kPi * static_cast<double>(h) / static_cast<double>(headings);
    const std::vector<Turned> seen = turned(stations, yaw_rad, magnetometer_m);
    double best = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& place_m : places_m_) {
      const Found found{log_density(seen, place_m, field, model), Pose2::from(place_m, yaw_rad)};
      best = std::max(best, found.log_density);
      if (found.log_density > best - options_.below_best) by_heading[h].push_back(found);
    }
  });
  std::vector<Found> all;
  for (const auto& some : by_heading) all.insert(all.end(), some.begin(), some.end());
  std::ranges::sort(all, [](const Found& a, const Found& b) {
    return std::tuple(-a.log_density, a.map_T_base.x, a.map_T_base.y, a.map_T_base.yaw) <
           std::tuple(-b.log_density, b.map_T_base.x, b.map_T_base.y, b.map_T_base.yaw);
  });
  std::vector<Pose2> poses;
  for (const Found& found : all)
    if (poses.size() < options_.max_poses &&
        found.log_density > all.front().log_density - options_.below_best)
      poses.push_back(found.map_T_base);
  return poses;
}

}  // namespace mstsl::joint
