#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mstsl/core/pose2.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/sim/segment.hpp"
#include "mstsl/sim/steel.hpp"

/// The steel that buildings are made of, as rods with plausible cross-sections, heights and remanence. Each
/// function appends to `rods`; lengths in m, map frame, floor at z = 0.
namespace mstsl::sim {

using Rods = std::vector<Rod>;

/// A reinforced slab over a rectangle of a frame: bars of both directions in pieces, at height `z_m`.
void add_slab(Rods& rods, const Pose2& map_T_area, const Eigen::AlignedBox2d& area_m, double z_m,
              Random& random);

/// The beams that carry such a slab, in the depth below `z_m`: across the area every `spacing_m` and along
/// its edges.
void add_beams(Rods& rods, const Pose2& map_T_area, const Eigen::AlignedBox2d& area_m, double z_m,
               double spacing_m, Random& random);

/// A reinforced-concrete or rolled-steel column from the floor to the ceiling.
void add_concrete_column(Rods& rods, const Eigen::Vector2d& at_m, double height_m, Random& random);
void add_steel_column(Rods& rods, const Eigen::Vector2d& at_m, double height_m, Random& random);

/// A pressed-steel frame: two jambs and a lintel, the opening along the pose's x axis; some doors are of
/// steel too.
void add_door_frame(Rods& rods, const Pose2& map_T_door, double width_m, Random& random);

/// A panel radiator along the pose's x axis.
void add_radiator(Rods& rods, const Pose2& map_T_radiator, double width_m, Random& random);

/// Cable tray, duct or pipe below the ceiling.
void add_tray(Rods& rods, const Segment& course, double z_m, Random& random);

/// A sheet-steel cupboard or shelf: four posts, width along the pose's x axis.
void add_cabinet(Rods& rods, const Pose2& map_T_cabinet, const Eigen::Vector2d& size_m, double height_m,
                 Random& random);

/// A heavy machine, lift shaft or stair: long thick rods in all directions.
void add_machine(Rods& rods, const Eigen::Vector2d& at_m, double size_m, Random& random);

/// A car along the pose's x axis: engine, axles, sills, roof.
void add_car(Rods& rods, const Pose2& map_T_car, const Eigen::Vector2d& size_m, Random& random);

/// A pallet rack's upright frame (two posts with bracing) and the beams of one bay.
void add_rack_frame(Rods& rods, const Pose2& map_T_frame, double depth_m, double height_m, Random& random);
void add_rack_beam(Rods& rods, const Segment& course, double z_m, Random& random);

}  // namespace mstsl::sim
