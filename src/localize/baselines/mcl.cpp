#include "mstsl/localize/baselines/mcl.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/random.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include "mstsl/core/random.hpp"

namespace mstsl {
namespace {

using mrpt::bayes::CParticleFilter;
using mrpt::maps::COccupancyGridMap2D;

/// MRPT draws from one generator for the whole process: who holds this has it to himself.
std::mutex& generator() {
  static std::mutex mutex;
  return mutex;
}

/// In the axes of the grid, which MRPT wants to lie straight.
COccupancyGridMap2D::Ptr grid_of(const OccupancyGrid& occupancy, const MclOptions& options) {
  const GridGeometry& g = occupancy.geometry();
  const auto side = static_cast<float>(g.resolution_m);
  auto grid = COccupancyGridMap2D::Create();
  grid->setSize(0.0F, side * static_cast<float>(g.columns), 0.0F, side * static_cast<float>(g.rows), side);
  for (std::size_t i = 0; i < g.size(); ++i) {
    const Cell cell = g.cell(i);
    const CellState state = occupancy.values()[i];
    grid->setCell(cell.column, cell.row,
                  state == CellState::kFree       ? 0.99F
                  : state == CellState::kOccupied ? 0.01F
                                                  : 0.5F);
  }
  auto& likelihood = grid->likelihoodOptions;
  likelihood.likelihoodMethod = COccupancyGridMap2D::lmLikelihoodField_Thrun;
  likelihood.LF_stdHit = static_cast<float>(options.sigma_hit_m);
  likelihood.LF_zHit = static_cast<float>(options.hit_share);
  likelihood.LF_zRandom = static_cast<float>(options.random_share);
  likelihood.LF_maxCorrsDistance = 2.0F;  // laser_likelihood_max_dist
  likelihood.LF_decimation = 1;           // the scan is thinned before
  return grid;
}

mrpt::obs::CObservation2DRangeScan::Ptr observation_of(const LaserScan& scan, const Rig& rig,
                                                       std::size_t beams) {
  auto observation = mrpt::obs::CObservation2DRangeScan::Create();
  const std::size_t step = std::max<std::size_t>(1, scan.ranges_m.size() / beams),
                    count = (scan.ranges_m.size() + step - 1) / step;
  const double aperture = scan.angle_increment_rad * static_cast<double>(step * (count - 1));
  observation->aperture = static_cast<float>(std::abs(aperture));
  observation->rightToLeft = aperture >= 0.0;
  observation->maxRange = static_cast<float>(scan.range_max_m);
  const Eigen::Matrix3d r = rig.base_T_laser.linear();
  const double yaw = std::atan2(r(1, 0), r(0, 0)) + scan.angle_min_rad + 0.5 * aperture;
  observation->sensorPose = mrpt::poses::CPose3D(rig.base_T_laser.translation().x(),
                                                 rig.base_T_laser.translation().y(), 0.0, yaw, 0.0, 0.0);
  observation->resizeScan(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float range = scan.ranges_m[i * step];
    const bool valid = std::isfinite(range) && range >= scan.range_min_m && range <= scan.range_max_m;
    observation->setScanRange(i, valid ? range : 0.0F);
    observation->setScanRangeValidity(i, valid);
  }
  return observation;
}

mrpt::obs::CActionRobotMovement2D movement_of(const Pose2& last_T_base, double alpha) {
  mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
  // MRPT's other model (Thrun's) takes a turn on the spot for two turns of 180 deg, with the noise of both.
  model.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
  model.gaussianModel.a1 = alpha;  // m/m
  model.gaussianModel.a3 = alpha;  // rad/m
  model.gaussianModel.a4 = alpha;  // rad/rad
  mrpt::obs::CActionRobotMovement2D movement;
  movement.computeFromOdometry({last_T_base.x, last_T_base.y, last_T_base.yaw}, model);
  return movement;
}

double free_m2(const OccupancyGrid& occupancy) {
  const double side_m = occupancy.geometry().resolution_m;
  return side_m * side_m * static_cast<double>(count(occupancy, CellState::kFree));
}

}  // namespace

struct Mcl::State {
  std::shared_ptr<const LocalizationMaps> maps;
  Rig rig;
  MclOptions options;
  Random random;
  OdometryTrack track;
  COccupancyGridMap2D::Ptr grid;
  mrpt::maps::CMultiMetricMap::Ptr map = mrpt::maps::CMultiMetricMap::Create();
  mrpt::slam::CMonteCarloLocalization2D particles;
  CParticleFilter filter;
  std::optional<Stamp> last_scan;
  std::optional<TimedPose> last_step;
  double travelled_m = 0.0;
  std::optional<double> narrow_since_m;  ///< since when (m travelled) its particles are close together
  Pose2 mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity() * 1e6;
  double probability = 0.0;
  bool was_localized = false;
  std::uint64_t updates = 0;

  State(std::shared_ptr<const LocalizationMaps> both, const Rig& its_rig, const MclOptions& wanted)
      : maps(std::move(both)),
        rig(its_rig),
        options(wanted),
        random(wanted.seed),
        track(wanted.odometry),
        grid(grid_of(maps->occupancy, wanted)) {
    map->maps.push_back(grid);
    filter.m_options.adaptiveSampleSize = true;
    filter.m_options.PF_algorithm = CParticleFilter::pfStandardProposal;
    filter.m_options.resamplingMethod =
        CParticleFilter::prMultinomial;  // the one that may change their number
    filter.m_options.powFactor = options.temper;
    particles.options.metricMap = map;
    auto& kld = particles.options.KLD_params;
    kld.KLD_binSize_XY = 0.5, kld.KLD_binSize_PHI = radians(10.0);
    kld.KLD_delta = 0.01, kld.KLD_epsilon = options.kld_error;
    const auto wished = static_cast<std::size_t>(options.particles_per_m2 * free_m2(maps->occupancy));
    const std::size_t most = std::max(options.most_particles, wished);
    kld.KLD_minSampleSize = static_cast<unsigned>(options.least_particles);
    kld.KLD_maxSampleSize = static_cast<unsigned>(most);
    const std::lock_guard lock(generator());
    reseed();
    particles.resetUniformFreeSpace(grid.get(), 0.7, static_cast<int>(most));
  }

  /// A run draws the same numbers whatever other runs draw at the same time. Expects the generator locked.
  void reseed() {
    mrpt::random::getRandomGenerator() =
        mrpt::random::CRandomGenerator(static_cast<std::uint32_t>(random.index(1u << 31)));
  }

  void update(const LaserScan& scan, const Pose2& last_T_base) {
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation_of(scan, rig, options.beams));
    const std::lock_guard lock(generator());
    reseed();
    mrpt::obs::CActionCollection actions;
    actions.insert(movement_of(last_T_base, options.alpha));
    filter.executeOn(particles, &actions, &frame);
    ++updates;
    conclude();
  }

  void conclude() {
    const auto [cov, pose] = particles.getCovarianceAndMean();
    mean = maps->occupancy.geometry().map_T_grid * Pose2{pose.x(), pose.y(), pose.phi()};
    const Eigen::Matrix2d turn = maps->occupancy.geometry().map_T_grid.rotation();
    Eigen::Matrix3d map_R_grid = Eigen::Matrix3d::Identity();
    map_R_grid.topLeftCorner<2, 2>() = turn;
    covariance = map_R_grid * cov.asEigen() * map_R_grid.transpose();
    double near = 0.0, all = 0.0;
    for (const auto& particle : particles.m_particles) {
      const double weight = std::exp(particle.log_w);
      const bool close = std::hypot(particle.d.x - pose.x(), particle.d.y - pose.y()) <= 0.5 &&
                         std::abs(angle_between(particle.d.phi, pose.phi())) <= radians(10.0);
      all += weight, near += close ? weight : 0.0;
    }
    probability = all > 0.0 ? near / all : 0.0;
    const bool narrow = std::sqrt(covariance.topLeftCorner<2, 2>().trace() / 2) <= options.answer_below_m &&
                        std::sqrt(covariance(2, 2)) <= options.answer_below_rad;
    if (!narrow) narrow_since_m.reset();
    if (narrow && !narrow_since_m) narrow_since_m = travelled_m;
    was_localized = was_localized || converged();
  }

  bool converged() const { return narrow_since_m && travelled_m - *narrow_since_m >= options.answer_after_m; }
};

Mcl::Mcl(std::shared_ptr<const LocalizationMaps> maps, const Rig& rig, const MclOptions& options)
    : state_(std::make_unique<State>(std::move(maps), rig, options)) {}
Mcl::Mcl(Mcl&&) noexcept = default;
Mcl& Mcl::operator=(Mcl&&) noexcept = default;
Mcl::~Mcl() = default;

void Mcl::observe(const OdometryReading& odometry) { state_->track.add(odometry); }
void Mcl::observe(const OdometryRestart& restart) { state_->track.restart(restart); }

void Mcl::observe(const LaserScan& scan) {
  State& s = *state_;
  if (s.last_scan && scan.stamp <= *s.last_scan) return;
  s.last_scan = scan.stamp;
  const std::optional<Pose2> track_T_base = s.track.at(scan.stamp);
  if (!track_T_base || scan.ranges_m.size() < 2) return;
  const Pose2 step = s.last_step ? between(s.last_step->pose, *track_T_base) : Pose2{};
  if (s.last_step && step.position().norm() < s.options.update_every_m &&
      std::abs(step.yaw) < s.options.update_every_rad)
    return;
  s.last_step = {scan.stamp, *track_T_base};
  s.travelled_m = s.track.travelled_m();
  s.update(scan, step);
}

Estimate Mcl::estimate() const {
  const State& s = *state_;
  Estimate estimate;
  if (!s.last_step) return estimate;
  estimate.stamp = s.last_step->stamp;
  estimate.travelled_m = s.travelled_m;
  estimate.covariance = s.covariance;
  estimate.probability = s.probability;
  estimate.hypotheses = {{s.mean, s.probability}};
  estimate.status = s.converged()     ? LocalizationStatus::kLocalized
                    : s.was_localized ? LocalizationStatus::kLost
                                      : LocalizationStatus::kSearching;
  if (s.converged()) estimate.map_T_base = s.mean;
  return estimate;
}

LocalizerReport Mcl::report() const {
  return {
      {{"filter updates", state_->updates}, {"particles at the end", state_->particles.m_particles.size()}},
      {}};
}

}  // namespace mstsl
