#include "mstsl/localize/joint/mode_bank.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <Eigen/Cholesky>

#include "mstsl/grid/occupancy_grid.hpp"
#include "mstsl/scan/fit_around.hpp"

namespace mstsl::joint {
namespace {

double square(double x) { return x * x; }

constexpr std::size_t kSearched = 5;  // so many of the best modes are searched around

bool heavier(const Mode& a, const Mode& b) {
  return std::tuple(-a.log_weight, a.map_T_base.x, a.map_T_base.y, a.map_T_base.yaw) <
         std::tuple(-b.log_weight, b.map_T_base.x, b.map_T_base.y, b.map_T_base.yaw);
}

/// Squared distance of two modes' poses in their common standard deviations, cells of the map added.
double squared_distance(const Mode& a, const Mode& b) {
  const Eigen::Vector3d off = difference(b.map_T_base, a.map_T_base);
  Eigen::Matrix3d sum = a.pose_covariance() + b.pose_covariance();
  sum.diagonal() += Eigen::Vector3d(0.02 * 0.02, 0.02 * 0.02, 0.005 * 0.005);
  return off.dot(sum.ldlt().solve(off));
}

/// The Gaussian with the weight, mean and covariance of both (the pose's mean taken where the heavier is).
Mode merged_modes(const Mode& a, const Mode& b) {
  const double share_b = 1.0 / (1.0 + std::exp(a.log_weight - b.log_weight));
  Vector off = b.state - a.state;
  off.head<3>() = difference(a.map_T_base, b.map_T_base);
  Mode both = a;
  both.map_T_base =
      Pose2::from(a.map_T_base.position() + share_b * off.head<2>(), a.map_T_base.yaw + share_b * off(2));
  both.state.tail<kStates - 3>() += share_b * off.tail<kStates - 3>();
  both.covariance =
      (1 - share_b) * a.covariance + share_b * b.covariance + share_b * (1 - share_b) * off * off.transpose();
  both.log_weight = a.log_weight - std::log1p(-share_b);
  both.scale.weight = (1 - share_b) * a.scale.weight + share_b * b.scale.weight;
  both.scale.squares = (1 - share_b) * a.scale.squares + share_b * b.scale.squares;
  both.field_account = (1 - share_b) * a.field_account + share_b * b.field_account;
  both.scan_account = (1 - share_b) * a.scan_account + share_b * b.scan_account;
  both.changed = (1 - share_b) * a.changed + share_b * b.changed;
  return both;
}

/// How well a mode can stand where it does, beyond its score: nobody stands inside a wall.
double standing(const OccupancyGrid& occupancy, const Pose2& pose) {
  switch (state_at(occupancy, pose.position())) {
    case CellState::kFree:
      return 1.0;
    case CellState::kUnknown:
      return 0.7;
    case CellState::kOccupied:
      return 0.3;
  }
  return 1.0;
}

}  // namespace

ModeBank::ModeBank(std::shared_ptr<const Maps> maps, const Eigen::Vector2d& magnetometer_m,
                   const BankOptions& options)
    : maps_(std::move(maps)),
      magnetometer_m_(magnetometer_m),
      options_(options),
      elsewhere_(maps_->both->field_cells, options.field),
      since_evidence_m_(options.scan.new_after_m) {}

double ModeBank::elsewhere_share() const { return std::exp(log_elsewhere_); }

void ModeBank::advance(const Step& step) {
  move(step);
  weigh_by_field(step.stations);
  weigh_by_scan(step.points_base_m);
  leak(step);
  normalise();
  if (since_merge_m_ >= options_.fit_every_m) merge();
  drop();
}

void ModeBank::move(const Step& step) {
  Eigen::Matrix3d noise = options_.odometry.covariance(step.last_T_base);
  if (step.broken) noise.diagonal() += Eigen::Vector3d(0.3 * 0.3, 0.3 * 0.3, 0.15 * 0.15);
  for (Mode& mode : modes_) predict(mode, step.last_T_base, noise, options_.field.bias_walk_uT);
  elsewhere_.predict(step.last_T_base.yaw);
  const double moved_m = std::hypot(step.last_T_base.x, step.last_T_base.y);
  since_fit_m_ += moved_m, since_evidence_m_ += moved_m, since_merge_m_ += moved_m;
  since_found_m_ += moved_m;
  since_fit_rad_ += std::abs(step.last_T_base.yaw);
}

void ModeBank::weigh_by_field(const std::vector<Station>& stations) {
  if (stations.empty()) return;
  for (const Station& station : stations)
    log_elsewhere_ += options_.field_temper * elsewhere_.update_by_field(station);
  constexpr std::size_t kChunk = 128;
  parallel_for((modes_.size() + kChunk - 1) / kChunk, options_.threads, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(modes_.size(), (chunk + 1) * kChunk); ++i)
      for (const Station& station : stations) {
        const double told =
            options_.field_temper *
            update_by_field(modes_[i], station, maps_->both->field_cells, magnetometer_m_, options_.field);
        modes_[i].log_weight += told, modes_[i].field_account += told;
      }
  });
  spare_the_early();
}

void ModeBank::spare_the_early() {
  const std::size_t spared = std::min(modes_.size(), options_.spared);  // they are sorted, but for this step
  const double most = options_.early_loss + std::log(static_cast<double>(spared)) +
                      options_.early_loss_per_m * since_found_m_;
  if (spared == 0 || most > -options_.drop_below) return;
  const Mode& best = *std::ranges::min_element(modes_, heavier);
  const double least = best.field_account - most;
  for (Mode& mode : std::span(modes_).first(spared)) {
    const double back = std::max(0.0, least - mode.field_account);
    mode.log_weight += back, mode.field_account += back;
  }
}

double ModeBank::evidence_score(const PointSet& points, const Pose2& map_T_base) const {
  const OccupancyGrid& occupancy = maps_->both->occupancy;
  // A scan that sees nothing but what the map does not know says as much for a mode as for "none of these".
  const double unmapped = options_.scan.elsewhere_score - options_.scan.tolerance;
  return standing(occupancy, map_T_base) *
         mapped_score(occupancy, *maps_->walls, points, map_T_base, options_.fit.sigma_m, unmapped);
}

std::vector<double> ModeBank::fit_all(const PointSet& points) {
  std::vector<double> scores(modes_.size());
  constexpr std::size_t kChunk = 64;
  parallel_for((modes_.size() + kChunk - 1) / kChunk, options_.threads, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(modes_.size(), (chunk + 1) * kChunk); ++i) {
      const WallFit fit = fit_to_walls(*maps_->walls, points,
                                       {modes_[i].map_T_base, modes_[i].pose_covariance()}, options_.fit);
      update_by_scan(modes_[i], fit);
      scores[i] = evidence_score(points, fit.map_T_base);
      if (modes_.size() <= options_.few && i < kSearched && scores[i] < options_.search_below)
        search_around(modes_[i], scores[i], points);
    }
  });
  return scores;
}

void ModeBank::search_around(Mode& mode, double& score, const PointSet& points) const {
  const Surroundings around;
  const WallFit best = fit_around(*maps_->walls, points, mode.map_T_base, around, options_.fit);
  const double found = evidence_score(points, best.map_T_base);
  if (found < score + options_.search_gain) return;
  score = found;
  reseat(mode, best, around.spread(), 1.0);
  update_by_scan(mode, best);
}

void ModeBank::weigh_by_scan(const PointSet& points_base_m) {
  if (points_base_m.empty() || modes_.empty()) return;
  const bool due = modes_.size() <= options_.few || since_fit_m_ >= options_.fit_every_m ||
                   since_fit_rad_ >= options_.fit_every_rad;
  if (!due) return;
  since_fit_m_ = since_fit_rad_ = 0.0;
  const PointSet points = at_most(thinned(points_base_m, options_.scan.spacing_m), options_.scan.max_points);
  const std::vector<double> scores = fit_all(points);
  // The best fit among the modes that count is what this place can look like today.
  double reference = options_.scan.elsewhere_score;
  for (std::size_t i = 0; i < modes_.size(); ++i)
    if (modes_[i].log_weight > modes_.front().log_weight - 10.0) reference = std::max(reference, scores[i]);
  // What one place shows counts once, however many scans show it; of a place that is left, room is made for
  // new evidence in the same measure.
  const double renewed = std::min(1.0, since_evidence_m_ / options_.scan.new_after_m),
               told = std::min(1.0, since_evidence_m_ / options_.scan.sudden_after_m);
  since_evidence_m_ = 0.0;
  const auto evidence = [&](double score, double& account) {
    const double whole = -options_.scan.log_odds * std::max(0.0, reference - score - options_.scan.tolerance);
    account *= 1.0 - renewed;
    const double news = told * (whole - account);
    account += news;
    return news;
  };
  for (std::size_t i = 0; i < modes_.size(); ++i)
    modes_[i].log_weight += evidence(scores[i], modes_[i].scan_account);
  log_elsewhere_ += evidence(options_.scan.elsewhere_score, elsewhere_account_);
  best_score_ = scores.front();
}

void ModeBank::leak(const Step& step) {
  const double moved_m = std::hypot(step.last_T_base.x, step.last_T_base.y);
  const double carried = step.broken || step.after_dark ? options_.carried_in_the_dark : 0.0;
  const double chance = 1.0 - (1.0 - carried) * std::exp(-moved_m / options_.lost_every_m);
  if (modes_.empty() || !(chance > 0)) return;
  normalise();
  const double share = std::exp(log_elsewhere_);
  log_elsewhere_ = std::log(share + chance * (1.0 - share));
  for (Mode& mode : modes_) mode.log_weight += std::log1p(-chance);
}

void ModeBank::normalise() {
  double most = log_elsewhere_;
  for (const Mode& mode : modes_) most = std::max(most, mode.log_weight);
  double sum = std::exp(log_elsewhere_ - most);
  for (const Mode& mode : modes_) sum += std::exp(mode.log_weight - most);
  const double log_sum = most + std::log(sum);
  log_elsewhere_ -= log_sum;
  for (Mode& mode : modes_) mode.log_weight -= log_sum;
  std::sort(modes_.begin(), modes_.end(), heavier);
}

void ModeBank::merge() {
  since_merge_m_ = 0.0;
  constexpr double kCell_m = 0.3;
  struct Hash {
    std::size_t operator()(const std::pair<int, int>& key) const {
      return static_cast<std::size_t>(key.first) * 73856093u ^
             static_cast<std::size_t>(key.second) * 19349663u;
    }
  };
  std::unordered_map<std::pair<int, int>, std::vector<std::size_t>, Hash> kept_in;
  std::vector<Mode> kept;
  for (const Mode& mode : modes_) {
    const int x = static_cast<int>(std::floor(mode.map_T_base.x / kCell_m));
    const int y = static_cast<int>(std::floor(mode.map_T_base.y / kCell_m));
    bool merged = false;
    for (int dx = -1; dx <= 1 && !merged; ++dx)
      for (int dy = -1; dy <= 1 && !merged; ++dy) {
        const auto found = kept_in.find({x + dx, y + dy});
        if (found == kept_in.end()) continue;
        for (const std::size_t i : found->second) {
          if (!(squared_distance(kept[i], mode) < options_.merge_below)) continue;
          const Mode both = merged_modes(kept[i], mode);
          if (both.pose_covariance().topLeftCorner<2, 2>().trace() > square(options_.widest_m)) continue;
          kept[i] = both;
          merged = true;
          break;
        }
      }
    if (merged) continue;
    kept_in[{x, y}].push_back(kept.size());
    kept.push_back(mode);
  }
  modes_ = std::move(kept);
  std::sort(modes_.begin(), modes_.end(), heavier);
}

void ModeBank::drop() {
  if (modes_.empty()) return;
  std::erase_if(modes_, [least = modes_.front().log_weight + options_.drop_below](const Mode& mode) {
    return mode.log_weight < least;
  });
}

void ModeBank::add(const std::vector<WallFit>& places) {
  // Half a cell of the search's lattice, before the scan's own say.
  const Eigen::Matrix3d spread = Eigen::Vector3d(0.15 * 0.15, 0.15 * 0.15, 0.04 * 0.04).asDiagonal();
  std::vector<Mode> modes;
  for (const WallFit& place : places) {
    modes.push_back(make_mode(place.map_T_base, spread, options_.field));
    update_by_scan(modes.back(), place);
  }
  add_modes(std::move(modes));
}

void ModeBank::add(const std::vector<Pose2>& places, double step_m, double turn_rad) {
  const Eigen::Vector3d half(0.5 * step_m, 0.5 * step_m, 0.5 * turn_rad);
  std::vector<Mode> modes;
  for (const Pose2& place : places)
    modes.push_back(make_mode(place, half.cwiseAbs2().asDiagonal(), options_.field));
  add_modes(std::move(modes));
}

void ModeBank::add_modes(std::vector<Mode> modes) {
  if (modes.empty()) return;
  const double share = modes_.empty() ? 1.0 - options_.elsewhere_prior : 0.9;
  const double log_each = log_elsewhere_ + std::log(share / static_cast<double>(modes.size()));
  const double account = modes_.empty() ? 0.0 : modes_.front().field_account;
  since_found_m_ = 0.0;
  for (Mode& mode : modes) {
    mode.log_weight = log_each, mode.field_account = account;
    modes_.push_back(mode);
  }
  log_elsewhere_ += std::log1p(-share);
  normalise();
  since_merge_m_ = options_.fit_every_m;
}

}  // namespace mstsl::joint
