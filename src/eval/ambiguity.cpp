#include "mstsl/eval/ambiguity.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "mstsl/core/random.hpp"
#include "mstsl/grid/distance_field.hpp"
#include "mstsl/grid/ray.hpp"
#include "mstsl/localize/methods.hpp"

namespace mstsl {
namespace {

constexpr double kSpeed_m_s = 0.5;
constexpr double kStep_s = 0.05;
constexpr int kStepsAScan = 4;
constexpr int kDirections = 16;

/// A made-up drive: straight on from a pose.
class MadeUpDrive {
 public:
  MadeUpDrive(const LocalizationMaps& maps, const AmbiguityOptions& options, const Pose2& start,
              Random random)
      : maps_(maps), options_(options), start_(start), random_(random) {
    for (int k = 0; k < 3; ++k) bias_uT_[k] = random_.normal(0.0, options.bias_sd_uT);
    scale_ = 1.0 + random_.normal(0.0, options.scale_sd);
    drift_rad_per_m_ = random_.normal(0.0, options.drift_sd_rad_per_m);
    // The map's error, in its own standard deviations: another one each metre, changing evenly between.
    for (int m = 0; m <= static_cast<int>(std::ceil(options.drive_m)) + 1; ++m)
      off_.push_back({random_.normal(), random_.normal(), random_.normal()});
  }

  int steps() const { return static_cast<int>(std::ceil(options_.drive_m / (kSpeed_m_s * kStep_s))); }
  Pose2 at(int step) const { return start_ * Pose2{way_m(step), 0, 0}; }

  OdometryReading odometry(int step) const {
    const double s = scale_ * way_m(step), turned = drift_rad_per_m_ * s;
    return {stamp(step), {s, 0.5 * s * turned, turned}};
  }

  FieldReading field(int step) {
    const Pose2 pose = at(step);
    const FieldSampler::Sample here = maps_.field_cells.sample(pose.position());
    known_ += here.known ? 1.0 / (steps() + 1) : 0.0;
    const auto metre = static_cast<std::size_t>(way_m(step));
    const double share = way_m(step) - static_cast<double>(metre);
    Eigen::Vector3d field_uT = here.mean_uT;
    for (int k = 0; k < 3; ++k) {
      const double off = (1 - share) * off_[metre][k] + share * off_[metre + 1][k];
      field_uT[k] += std::sqrt(here.variance_uT2[k]) * off;
    }
    const Eigen::AngleAxisd base_R_map(-pose.yaw, Eigen::Vector3d::UnitZ());
    Eigen::Vector3d measured = base_R_map * field_uT + bias_uT_;
    for (int k = 0; k < 3; ++k) measured[k] += random_.normal(0.0, options_.noise_uT);
    return {stamp(step), measured};
  }

  LaserScan scan(int step) {
    const Pose2 pose = at(step);
    LaserScan scan{.stamp = stamp(step),
                   .angle_min_rad = -0.5 * options_.field_of_view_rad,
                   .angle_increment_rad = options_.field_of_view_rad / (options_.beams - 1),
                   .range_min_m = 0.05,
                   .range_max_m = options_.scan_range_m};
    for (int i = 0; i < options_.beams; ++i) {
      const double direction = pose.yaw + scan.angle_min_rad + i * scan.angle_increment_rad;
      const auto range = cast_ray(maps_.occupancy, pose.position(), direction, options_.scan_range_m);
      scan.ranges_m.push_back(range ? static_cast<float>(*range + random_.normal(0.0, options_.range_noise_m))
                                    : std::numeric_limits<float>::infinity());
    }
    return scan;
  }
  double field_known() const { return known_; }

 private:
  static Stamp stamp(int step) { return Stamp::from_seconds(1.0 + step * kStep_s); }
  static double way_m(int step) { return step * kStep_s * kSpeed_m_s; }

  const LocalizationMaps& maps_;
  const AmbiguityOptions& options_;
  Pose2 start_;
  Random random_;
  Eigen::Vector3d bias_uT_{0, 0, 0};
  double scale_ = 1.0, drift_rad_per_m_ = 0.0, known_ = 0.0;
  std::vector<Eigen::Vector3d> off_;
};

/// Drives and judges the first answer.
void drive(MadeUpDrive made_up, AnyLocalizer localizer, AmbiguousPlace& place) {
  std::optional<Pose2> off;
  for (int step = 0; step <= made_up.steps(); ++step) {
    localizer.observe(made_up.odometry(step));
    localizer.observe(made_up.field(step));
    if (step % kStepsAScan != 0) continue;
    localizer.observe(made_up.scan(step));
    const Estimate estimate = localizer.estimate();
    if (!estimate.map_T_base || off) continue;
    const int then = static_cast<int>(std::lround((estimate.stamp.seconds() - 1.0) / kStep_s));
    off = between(made_up.at(then), *estimate.map_T_base);
  }
  constexpr double kRight_m = 0.5, kRight_rad = radians(10.0);
  ++place.drives;
  place.field_known += made_up.field_known();
  if (!off) return;
  const bool right = std::hypot(off->x, off->y) <= kRight_m && std::abs(off->yaw) <= kRight_rad;
  ++(right ? place.right : place.wrong);
}

/// Whether a robot can go straight on from a pose.
bool is_clear(const DistanceField& walls, const OccupancyGrid& map, const Pose2& from,
              const AmbiguityOptions& options) {
  for (double s = 0.0; s <= options.drive_m; s += 0.1) {
    const Eigen::Vector2d at = from * Eigen::Vector2d(s, 0);
    if (state_at(map, at) != CellState::kFree || walls.at(at) < options.clearance_m) return false;
  }
  return true;
}

std::vector<AmbiguousPlace> places_of(const OccupancyGrid& map, const DistanceField& walls,
                                      const AmbiguityOptions& options) {
  std::vector<AmbiguousPlace> places;
  const GridGeometry& g = map.geometry();
  const int every = std::max(1, static_cast<int>(std::lround(options.spacing_m / g.resolution_m)));
  for (int row = every / 2; row < g.rows; row += every)
    for (int column = every / 2; column < g.columns; column += every) {
      const Cell cell{column, row};
      if (map[cell] == CellState::kFree && walls.at(cell) >= options.clearance_m)
        places.push_back({g.center_of(cell)});
    }
  return places;
}

}  // namespace

Result<std::vector<AmbiguousPlace>> find_ambiguity(std::shared_ptr<const LocalizationMaps> maps,
                                                   const AmbiguityOptions& options) {
  const DistanceField walls(maps->occupancy, 2.0 * options.clearance_m);
  std::vector<AmbiguousPlace> places = places_of(maps->occupancy, walls, options);
  MethodOptions one_thread;
  one_thread.threads = Threads{1};
  const auto joint = make_method("joint", maps, one_thread);
  if (!joint) return joint.error();
  std::atomic<bool> ended = false;
  std::mutex lock;
  std::size_t done = 0;
  parallel_for(places.size(), options.threads, [&](std::size_t i) {
    if (ended) return;
    Random random = Random(options.seed).fork(i);
    std::vector<Pose2> clear;
    for (int d = 0; d < kDirections; ++d) {
      const Pose2 start = Pose2::from(places[i].place_m, 2 * kPi * d / kDirections);
      if (is_clear(walls, maps->occupancy, start, options)) clear.push_back(start);
    }
    for (int k = 0; k < options.drives && !clear.empty(); ++k) {
      const std::size_t which = random.index(clear.size());
      drive(MadeUpDrive(*maps, options, clear[which], random.fork(k)), (*joint)(Rig{}), places[i]);
      clear.erase(clear.begin() + static_cast<std::ptrdiff_t>(which));
    }
    if (places[i].drives > 0) places[i].field_known /= places[i].drives;
    const std::lock_guard guard(lock);
    ++done;
    if (options.progress && !options.progress(static_cast<double>(done) / static_cast<double>(places.size())))
      ended = true;
  });
  if (ended) return Error("interrupted; nothing was written");
  return places;
}

}  // namespace mstsl
