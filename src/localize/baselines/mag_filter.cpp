#include "mstsl/localize/baselines/mag_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mstsl {
namespace {

/// A particle on ground where no robot can be is left this share of its weight: maps err by a cell.
constexpr double kOffGround = 1e-3;

Eigen::Matrix3d turned_by(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

std::vector<Cell> free_cells(const OccupancyGrid& grid) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < grid.values().size(); ++i)
    if (grid.values()[i] == CellState::kFree) cells.push_back(grid.geometry().cell(i));
  return cells;
}

}  // namespace

MagFilter::MagFilter(std::shared_ptr<const LocalizationMaps> maps, const Rig& rig,
                     const MagFilterOptions& options)
    : maps_(std::move(maps)), rig_(rig), options_(options), random_(options.seed), track_(options.odometry) {
  spread();
}

void MagFilter::spread() {
  const OccupancyGrid& grid = maps_->occupancy;
  const std::vector<Cell> cells = free_cells(grid);
  particles_.resize(options_.particles);
  for (Particle& particle : particles_) {
    const Eigen::Vector2d at = grid.geometry().center_of(cells[random_.index(cells.size())]);
    particle = {Pose2::from(at, random_.uniform(-kPi, kPi)), 1.0 / static_cast<double>(particles_.size())};
  }
}

void MagFilter::observe(const FieldReading& field) {
  const std::optional<Pose2> track_T_base = track_.at(field.stamp);
  if (!track_T_base || !field.sensor_field_uT.allFinite() || field.sensor_field_uT.norm() > 1e4) return;
  track_field_sum_uT_ +=
      turned_by(track_T_base->yaw) * (rig_.base_T_magnetometer.linear() * field.sensor_field_uT);
  ++readings_;
}

void MagFilter::observe(const LaserScan& scan) {
  if (last_scan_ && scan.stamp <= *last_scan_) return;
  last_scan_ = scan.stamp;
  const std::optional<Pose2> track_T_base = track_.at(scan.stamp);
  if (!track_T_base) return;
  const Pose2 step = last_step_ ? between(last_step_->pose, *track_T_base) : Pose2{};
  const bool moved =
      step.position().norm() >= options_.update_every_m || std::abs(step.yaw) >= options_.update_every_rad;
  if (last_step_ && !moved && scan.stamp - last_step_->stamp < options_.update_every_s) return;
  const bool first = !last_step_;
  last_step_ = {scan.stamp, *track_T_base};
  travelled_at_last_step_m_ = track_.travelled_m();
  move(step);
  // Standing still a reading says what the last one said.
  if (readings_ > 0 && (moved || first))
    weigh(turned_by(-track_T_base->yaw) * track_field_sum_uT_ / static_cast<double>(readings_));
  track_field_sum_uT_.setZero();
  readings_ = 0;
  conclude();
}

void MagFilter::move(const Pose2& last_T_base) {
  const Eigen::Matrix3d covariance = options_.noise.covariance(last_T_base);
  const Eigen::Vector3d sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (Particle& particle : particles_) {
    const double x = random_.normal(0, sigma.x()), y = random_.normal(0, sigma.y());
    particle.map_T_base = particle.map_T_base * Pose2{last_T_base.x + x, last_T_base.y + y,
                                                      last_T_base.yaw + random_.normal(0, sigma.z())};
  }
}

void MagFilter::weigh(const Eigen::Vector3d& base_field_uT) {
  ++updates_;
  std::vector<double> logs(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Pose2& pose = particles_[i].map_T_base;
    const Eigen::Vector3d lever = turned_by(pose.yaw) * rig_.base_T_magnetometer.translation();
    const auto sample = maps_->field_cells.sample(pose.position() + lever.head<2>());
    const Eigen::Vector3d off = turned_by(pose.yaw) * base_field_uT - sample.mean_uT;
    const Eigen::Array3d variance = sample.variance_uT2.array() + options_.sigma_uT * options_.sigma_uT;
    logs[i] = -0.5 * options_.temper * (off.array().square() / variance + variance.log()).sum();
    if (state_at(maps_->occupancy, pose.position()) != CellState::kFree) logs[i] += std::log(kOffGround);
    logs[i] += std::log(std::max(particles_[i].weight, 1e-300));
  }
  const double best = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0, squares = 0.0;
  for (double& log : logs) sum += log = std::exp(log - best);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_[i].weight = logs[i] / sum;
    squares += particles_[i].weight * particles_[i].weight;
  }
  if (1.0 / squares < 0.5 * static_cast<double>(particles_.size())) resample();
}

/// Systematic (Kitagawa 1996), then roughened.
void MagFilter::resample() {
  ++resamplings_;
  const double share = 1.0 / static_cast<double>(particles_.size());
  double at = random_.uniform() * share, sum = particles_.front().weight;
  std::vector<Particle> drawn;
  drawn.reserve(particles_.size());
  for (std::size_t i = 0; drawn.size() < particles_.size(); at += share) {
    while (sum < at && i + 1 < particles_.size()) sum += particles_[++i].weight;
    const double x = random_.normal(0, options_.roughen_m), y = random_.normal(0, options_.roughen_m);
    drawn.push_back({particles_[i].map_T_base * Pose2{x, y, random_.normal(0, options_.roughen_rad)}, share});
  }
  particles_ = std::move(drawn);
}

void MagFilter::conclude() {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), heading = Eigen::Vector2d::Zero();
  for (const Particle& p : particles_) {
    middle += p.weight * p.map_T_base.position();
    heading += p.weight * Eigen::Vector2d(std::cos(p.map_T_base.yaw), std::sin(p.map_T_base.yaw));
  }
  mean_ = Pose2::from(middle, std::atan2(heading.y(), heading.x()));
  covariance_.setZero();
  probability_ = 0.0;
  for (const Particle& p : particles_) {
    const Eigen::Vector2d off = p.map_T_base.position() - middle;
    const Eigen::Vector3d error(off.x(), off.y(), angle_between(mean_.yaw, p.map_T_base.yaw));
    covariance_ += p.weight * error * error.transpose();
    if (off.norm() <= 0.5 && std::abs(error.z()) <= radians(10.0)) probability_ += p.weight;
  }
  probability_ = std::min(1.0, probability_);
  if (probability_ >= options_.answer_from) was_localized_ = true;
}

Estimate MagFilter::estimate() const {
  Estimate estimate;
  if (!last_step_) return estimate;
  estimate.stamp = last_step_->stamp;
  estimate.travelled_m = travelled_at_last_step_m_;
  estimate.probability = probability_;
  estimate.hypotheses = {{mean_, probability_}};
  if (probability_ >= options_.answer_from) {
    estimate.status = LocalizationStatus::kLocalized;
    estimate.map_T_base = mean_;
    estimate.covariance = covariance_;
  } else if (was_localized_) {
    estimate.status = LocalizationStatus::kLost;
  }
  return estimate;
}

LocalizerReport MagFilter::report() const {
  return {{{"updates", updates_}, {"resamplings", resamplings_}}, {}};
}

}  // namespace mstsl
