#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"
#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/sim/segment.hpp"
#include "mstsl/sim/segment_index.hpp"
#include "mstsl/sim/steel.hpp"

namespace mstsl::sim {

/// A centre line along which robots drive, and the width that is free around it.
struct Lane {
  Segment center;
  double free_width_m = 0.0;
};

/// What may stand in one place today and in another tomorrow.
enum class ThingKind {
  kCar,          ///< in a parking bay
  kCabinet,      ///< steel cupboard against a wall
  kTrolley,      ///< small box on wheels
  kPallet,       ///< goods in a rack's lowest bay
  kHiddenSteel,  ///< furniture or machines behind a wall: magnetic, but no lidar sees it
};

/// Something movable where it stands, in the map frame.
struct Thing {
  std::vector<Segment> outline;  ///< at the lidar's height
  std::vector<Rod> steel;
};

/// A place where a thing of one kind may stand.
struct Spot {
  ThingKind kind = ThingKind::kTrolley;
  Pose2 map_T_spot;
  double occupancy = 0.5;  ///< probability that something stands there
  std::optional<Thing> thing;
};

/// All that is decided about a building: what a World is made from.
struct WorldPlan {
  std::string name;
  double axis_yaw_rad = 0.0;        ///< yaw of the building's axis in the map frame
  Eigen::AlignedBox2d footprint_m;  ///< beyond it nothing is known and nobody drives
  std::vector<Segment> walls;       ///< what never moves
  std::vector<Rod> steel;           ///< what never moves
  std::vector<Spot> spots;
  std::vector<Lane> lanes;
  EarthField earth;
  double magnetisation = 1.0;           ///< factor on all remanence
  std::optional<OccupancyGrid> ground;  ///< the map it was made from, if any: robots stay on its free cells
};

/// A building as a robot meets it on one day: exact walls, a magnetic field, and the ground it may drive on.
class World {
 public:
  explicit World(WorldPlan plan);

  const WorldPlan& plan() const { return plan_; }
  const std::string& name() const { return plan_.name; }
  const std::vector<Lane>& lanes() const { return plan_.lanes; }
  /// Walls and the outlines of all that stands about today.
  const SegmentIndex& surfaces() const { return surfaces_; }
  Eigen::Vector3d field_uT(const Eigen::Vector3d& position_m) const { return field_.field_uT(position_m); }
  const SteelField& field() const { return field_; }

  /// Distance to the nearest surface at each point of the driveable ground (at most kMaxClearance_m), and 0
  /// where a robot never comes from the lanes.
  const Grid<float>& clearance_m() const { return clearance_m_; }
  /// 1 on that ground within the free width of a lane, 0 beside (empty bays, corners of rooms); the same
  /// cells.
  const Grid<std::uint8_t>& on_lane() const { return on_lane_; }
  static constexpr double kMaxClearance_m = 2.0;
  /// The robot's centre stays this far from every surface: a 0.5 m wide robot and a hand's margin.
  static constexpr double kRobotClearance_m = 0.3;

 private:
  WorldPlan plan_;
  SegmentIndex surfaces_;
  SteelField field_;
  Grid<float> clearance_m_;
  Grid<std::uint8_t> on_lane_;
};

struct WorldOptions {
  Eigen::Vector2d size_m =
      Eigen::Vector2d::Zero();  ///< outer length and width; zero takes the world's own default
  EarthField earth;
  double asymmetry_m =
      0.02;  ///< SD by which copies of a detail differ, as built; the real corridor loop has 1-3 cm
  double magnetisation =
      1.0;  ///< factor on all remanence, for studies of weaker and stronger steel; 1 is realistic
  double car_occupancy = 0.6;  ///< share of bays with a parked car
};

/// The built-in worlds: corridor, carpark, warehouse, office-wing, and those of the hard protocol:
/// symmetric-loop, aisles, pillar-hall, h-wing, office.
std::vector<std::string> world_names();

/// A world by name. Errors: a name that is not there (the message lists those that are), a size too small to
/// build in.
Result<World> make_world(std::string_view name, const WorldOptions& options, const Random& random);

/// A world whose walls are the occupied cells of a map, traced into segments; lanes from its free space;
/// steel as a building of that outline has it. Errors: a map without free cells wide enough to drive on.
Result<World> world_from_map(const OccupancyGrid& map, const WorldOptions& options, const Random& random);

/// What changes at a spot that is decided anew.
enum class Change {
  kThings,     ///< what stands there: seen by the lidar and by the magnetometer
  kSteelOnly,  ///< its steel; the outline stays (other goods in the same cupboard)
};

/// The same building on a later day: each spot is, with probability `moved_fraction`, decided anew.
World on_another_day(const World& world, double moved_fraction, const Random& random,
                     Change change = Change::kThings);

}  // namespace mstsl::sim
