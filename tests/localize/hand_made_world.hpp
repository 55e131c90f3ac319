#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/trajectory.hpp"
#include "mstsl/grid/ray.hpp"
#include "mstsl/localize/localization_maps.hpp"

#include "test_support.hpp"

/// A small building drawn by hand, with sensors free of noise: what goes wrong in it is the method's own
/// fault.
namespace mstsl::test {

/// A ring of corridors, 24 m x 10 m outside and 2 m wide, with recesses in the walls that are nearly
/// symmetric under half a turn. `map_T_world` lays the whole building, its field and its map's grid
/// elsewhere.
struct HandMadeWorld {
  Pose2 map_T_world;
  OccupancyGrid map;
  std::shared_ptr<const LocalizationMaps> maps;

  explicit HandMadeWorld(const Pose2& map_T_its_world = {}) : map_T_world(map_T_its_world), map(drawn()) {
    maps = must(make_localization_maps(map, field_map()));
  }

  static bool solid(const Eigen::Vector2d& p) {
    const bool ring = p.x() > 0 && p.y() > 0 && p.x() < 24 && p.y() < 10 &&
                      !(p.x() > 2 && p.x() < 22 && p.y() > 2 && p.y() < 8);
    const auto recess = [&p](double x, double y) {
      return std::abs(p.x() - x) < 0.5 && std::abs(p.y() - y) < 0.2;
    };
    const bool open = recess(4, 0) || recess(9, 10) || recess(12, 2) || recess(12, 8) || recess(20, 10) ||
                      recess(15, 0) || recess(17.5, 0);
    return !ring && !open;
  }

  /// The field at a point of the world, in the world's axes: the Earth's and waves of 1.5 to 5 m, 7 uT rms an
  /// axis. Each axis has its own waves, as real fields do: where axes share them, a vector recurs every few
  /// metres and no method tells the places apart by one reading.
  static Eigen::Vector3d field_in_world_uT(const Eigen::Vector2d& p) {
    const auto wave = [&p](double kx, double ky, double phase) {
      return std::sin(kx * p.x() + ky * p.y() + phase);
    };
    return {3 + 7 * wave(2.1, 0.7, 0.0) + 7 * wave(1.13, -1.7, 0.4),
            20 + 7 * wave(1.6, -2.9, 1.0) + 7 * wave(0.93, 1.4, 2.9),
            -43 + 7 * wave(3.7, 1.9, 2.0) + 7 * wave(-1.27, 2.7, 1.6)};
  }

  Eigen::Vector3d field_uT(const Eigen::Vector2d& map_point_m) const {
    return Eigen::AngleAxisd(map_T_world.yaw, Eigen::Vector3d::UnitZ()) *
           field_in_world_uT(inverse(map_T_world) * map_point_m);
  }

  OccupancyGrid drawn() const {
    const Pose2 world_T_grid{-0.5, -0.5, 0.0};
    const GridGeometry geometry{0.05, 500, 220, map_T_world * world_T_grid};
    OccupancyGrid grid(geometry, CellState::kUnknown);
    const auto center = [&](Cell cell) {
      return Eigen::Vector2d(0.05 * cell.column - 0.475, 0.05 * cell.row - 0.475);
    };
    for (std::size_t i = 0; i < geometry.size(); ++i) {
      const Eigen::Vector2d p = center(geometry.cell(i));
      if (!solid(p)) {
        grid.values()[i] = CellState::kFree;
        continue;
      }
      for (const double dx : {-0.05, 0.0, 0.05})
        for (const double dy : {-0.05, 0.0, 0.05})
          if (!solid(p + Eigen::Vector2d(dx, dy))) grid.values()[i] = CellState::kOccupied;
    }
    return grid;
  }

  FieldMap field_map() const {
    FieldMap field;
    field.geometry = map.geometry();
    field.mean_uT.assign(field.geometry.size(),
                         Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    field.variance_uT2 = field.mean_uT;
    field.supported.assign(field.geometry.size(), 0);
    for (std::size_t i = 0; i < field.geometry.size(); ++i) {
      if (map.values()[i] != CellState::kFree) continue;
      field.mean_uT[i] = field_uT(field.geometry.center_of(field.geometry.cell(i))).cast<float>();
      field.variance_uT2[i].setConstant(0.1F);
      field.supported[i] = 1;
    }
    return field;
  }

  LaserScan scan_at(Stamp stamp, const Pose2& map_T_base, const Eigen::Isometry3d& base_T_laser) const {
    LaserScan scan{stamp, radians(-135), radians(0.5), 0.0, 0.1, 30.0, {}};
    const Pose2 map_T_laser = map_T_base * to_pose2(base_T_laser);
    for (int beam = 0; beam < 541; ++beam) {
      const double direction = map_T_laser.yaw + scan.angle_min_rad + beam * scan.angle_increment_rad;
      const auto range = cast_ray(map, map_T_laser.position(), direction, 30.0);
      scan.ranges_m.push_back(range ? static_cast<float>(*range + 0.02)
                                    : std::numeric_limits<float>::infinity());
    }
    return scan;
  }

  FieldReading field_at(Stamp stamp, const Pose2& map_T_base,
                        const Eigen::Isometry3d& base_T_magnetometer) const {
    const Eigen::Isometry3d map_T_sensor = to_isometry3(map_T_base) * base_T_magnetometer;
    return {stamp, map_T_sensor.linear().transpose() * field_uT(map_T_sensor.translation().head<2>())};
  }
};

/// What the robot does: stands for a second, turns, stands for a second, turns, and drives straight on.
struct Drive {
  Pose2 map_T_start;
  double first_turn_rad = 0.0;
  double second_turn_rad = 0.0;
  double length_m = 6.0;
};

/// The true poses of a drive at 50 Hz.
inline Trajectory driven(const Drive& drive) {
  Trajectory truth;
  Pose2 pose = drive.map_T_start;
  int tick = 0;
  const auto hold = [&](int ticks, const Pose2& step) {
    for (int i = 0; i < ticks; ++i) truth.add(Stamp::from_seconds(100 + 0.02 * tick++), pose = pose * step);
  };
  hold(50, {});
  hold(100, {0, 0, drive.first_turn_rad / 100});
  hold(50, {});
  hold(100, {0, 0, drive.second_turn_rad / 100});
  hold(static_cast<int>(drive.length_m / 0.01), {0.01, 0, 0});
  return truth;
}

/// The events of a drive: odometry and field at 50 Hz, scans at 10 Hz.
inline std::vector<SensorEvent> events_of(const HandMadeWorld& world, const Drive& drive, const Rig& rig) {
  std::vector<SensorEvent> events;
  const Trajectory truth = driven(drive);
  const Pose2 odom_T_map = Pose2{3.0, -1.0, 0.4} * inverse(drive.map_T_start);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& [stamp, pose] = truth[i];
    events.emplace_back(OdometryReading{stamp, odom_T_map * pose});
    events.emplace_back(world.field_at(stamp, pose, rig.base_T_magnetometer));
    if (i % 5 == 0) events.emplace_back(world.scan_at(stamp, pose, rig.base_T_laser));
  }
  return events;
}

}  // namespace mstsl::test
