#include "mstsl/localize/joint/joint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

namespace mstsl {
namespace {

constexpr std::size_t kMostHypotheses = 20;  // as many as an estimate lists
constexpr double kRight_m = 0.5;             // what a right pose is
constexpr double kRight_rad = radians(10.0);

bool same_place(const Pose2& a, const Pose2& b) {
  return distance(a, b) <= kRight_m && std::abs(angle_between(a.yaw, b.yaw)) <= kRight_rad;
}

/// The probability that a mode's true pose is right as far as `pose` is: along its widest direction.
double share_near(const joint::Mode& mode, const Pose2& pose) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(mode.pose_covariance().topLeftCorner<2, 2>());
  const double sigma_m = std::sqrt(std::max(eigen.eigenvalues()(1), 1e-8));
  const double off_m = eigen.eigenvectors().col(1).dot(mode.map_T_base.position() - pose.position());
  const auto below = [&](double x) { return 0.5 * std::erfc(-x / (sigma_m * std::sqrt(2.0))); };
  return below(kRight_m - off_m) - below(-kRight_m - off_m);
}

/// The modes as places: each stands for those within 0.5 m and 10 deg of it.
std::vector<Hypothesis> places(const std::vector<joint::Mode>& modes) {
  std::vector<Hypothesis> list;
  for (const joint::Mode& mode : modes) {
    const double weight = std::exp(mode.log_weight);
    const auto same = std::ranges::find_if(
        list, [&](const Hypothesis& h) { return same_place(h.map_T_base, mode.map_T_base); });
    if (same != list.end())
      same->weight += weight;
    else if (list.size() < kMostHypotheses)
      list.push_back({mode.map_T_base, weight});
  }
  std::ranges::stable_sort(list,
                           [](const Hypothesis& a, const Hypothesis& b) { return a.weight > b.weight; });
  return list;
}

}  // namespace

Joint::Joint(std::shared_ptr<const joint::Maps> maps, const Rig& rig, const JointOptions& options)
    : maps_(std::move(maps)),
      rig_(rig),
      options_(options),
      track_(options.odometry),
      stations_(rig, options.stations),
      bank_(maps_, rig.base_T_magnetometer.translation().head<2>(), options.bank) {}

void Joint::observe(const OdometryReading& odometry) {
  track_.add(odometry);
  take_waiting(false);
}

void Joint::observe(const FieldReading& field) {
  // No magnetometer reads more than some thousands of uT; a larger number is in another unit, or noise.
  constexpr double kLargest_uT = 1e5;
  if (!(field.sensor_field_uT.norm() < kLargest_uT) || (last_field_ && field.stamp <= *last_field_)) {
    ++counts_.bad_field;
    return;
  }
  watch_for_dark(field.stamp);
  last_field_ = field.stamp;
  waiting_.push_back(field);
  // Odometry that comes later than this does not come: the drive goes on without these readings.
  constexpr double kPatience_s = 3.0;
  while (field.stamp - waiting_.front().stamp > kPatience_s) {
    waiting_.pop_front();
    ++counts_.field_without_odometry;
  }
  take_waiting(false);
}

void Joint::take_waiting(bool now) {
  while (!waiting_.empty() && (now || track_.covers(waiting_.front().stamp))) {
    const FieldReading field = waiting_.front();
    waiting_.pop_front();
    const std::optional<Pose2> track_T_base = track_.at(field.stamp);
    if (!track_T_base) {
      ++counts_.field_without_odometry;
      continue;
    }
    stations_.add(field, *track_T_base);
    // Scans may be far apart: on the way, the field alone takes the modes along.
    if (last_step_ && distance(last_step_->pose, *track_T_base) >= options_.step_without_scan_m)
      advance(make_step(field.stamp, *track_T_base), *track_T_base);
  }
}

void Joint::advance(const joint::Step& step, const Pose2& track_T_base) {
  counts_.stations += step.stations.size();
  bank_.advance(step);
  remember(step, track_T_base);
  search_if_due(step, track_T_base);
  judge(step.last_T_base);
  last_step_ = {step.stamp, track_T_base};
  breaks_at_last_step_ = track_.breaks();
}

void Joint::observe(const LaserScan& scan) {
  if (last_scan_ && scan.stamp <= *last_scan_) {
    ++counts_.late_scans;
    return;
  }
  watch_for_dark(scan.stamp);
  last_scan_ = scan.stamp;
  const std::optional<Pose2> track_T_base = track_.at(scan.stamp);
  if (!track_T_base) {
    ++counts_.scans_without_odometry;
    return;
  }
  if (!worth_processing(scan.stamp, *track_T_base)) return;
  take_waiting(true);
  joint::Step step = make_step(scan.stamp, *track_T_base);
  step.points_base_m = points_of(scan, *track_T_base);
  advance(step, *track_T_base);
  processed_ = {scan.stamp, *track_T_base};
  travelled_m_ = track_.travelled_m();
}

void Joint::watch_for_dark(Stamp now) {
  // Two seconds, and ten times what is usual: a lidar of 1 Hz alone is no darkness.
  constexpr double kDark_s = 2.0, kUsual = 10.0, kForget = 0.02;
  const std::optional<Stamp> last = std::max(last_scan_, last_field_);
  if (!last) return;
  const double gap_s = now - *last;
  if (gap_s > std::max(kDark_s, kUsual * usual_gap_s_))
    after_dark_ = true;
  else
    usual_gap_s_ += kForget * (std::max(gap_s, 0.0) - usual_gap_s_);
}

bool Joint::worth_processing(Stamp stamp, const Pose2& track_T_base) const {
  if (!processed_) return true;
  return distance(processed_->pose, track_T_base) >= options_.process_every_m ||
         std::abs(angle_between(processed_->pose.yaw, track_T_base.yaw)) >= options_.process_every_rad ||
         stamp - processed_->stamp >= options_.process_every_s;
}

joint::Step Joint::make_step(Stamp stamp, const Pose2& track_T_base) {
  joint::Step step;
  step.stamp = stamp;
  step.last_T_base = last_step_ ? between(last_step_->pose, track_T_base) : Pose2{};
  step.broken = last_step_ && track_.breaks() != breaks_at_last_step_;
  step.after_dark = std::exchange(after_dark_, false);
  if (step.broken || step.after_dark) stations_.interrupt();
  step.stations = stations_.take(track_T_base);
  return step;
}

PointSet Joint::points_of(const LaserScan& scan, const Pose2& track_T_base) {
  const std::optional<Pose2> track_T_end = track_.at(scan.stamp + sweep_duration_s(scan));
  PointSet points =
      points_in_base(scan, rig_.base_T_laser, track_T_end ? between(track_T_base, *track_T_end) : Pose2{});
  if (points.size() >= options_.min_returns) return points;
  ++counts_.blind_scans;
  return {};
}

void Joint::search_if_due(const joint::Step& step, const Pose2& track_T_base) {
  if (bank_.elsewhere_share() < options_.search_above ||
      track_.travelled_m() - searched_at_m_ < options_.search_every_m)
    return;
  if (!search_by_scan(step)) search_by_field(track_T_base);
}

bool Joint::search_by_scan(const joint::Step& step) {
  if (step.points_base_m.empty()) return false;
  const FoundPlaces found = maps_->places.find(step.points_base_m, options_.bank.threads);
  if (!found.informative || found.fits.empty()) return false;
  ++counts_.searches;
  if (!found.complete) ++counts_.cut_searches;
  searched_at_m_ = track_.travelled_m();
  bank_.add(found.fits);
  return true;
}

void Joint::search_by_field(const Pose2& track_T_base) {
  if (passed_.empty() || track_.travelled_m() - passed_.front().travelled_m < options_.field_search_least_m)
    return;
  std::vector<joint::Station> way;
  for (const Passed& passed : passed_) {
    way.push_back(passed.station);
    way.back().base_T_then = between(track_T_base, passed.track_T_base);
  }
  ++counts_.field_searches;
  searched_at_m_ = track_.travelled_m();
  bank_.add(
      maps_->by_field.find(way, maps_->both->field_cells, rig_.base_T_magnetometer.translation().head<2>(),
                           options_.bank.field, options_.bank.threads),
      maps_->by_field.options().step_m, maps_->by_field.options().turn_rad);
}

void Joint::remember(const joint::Step& step, const Pose2& track_T_base) {
  if (step.broken) passed_.clear();
  for (const joint::Station& station : step.stations)
    passed_.push_back({track_T_base * station.base_T_then, track_.travelled_m(), station});
  while (!passed_.empty() &&
         track_.travelled_m() - passed_.front().travelled_m > options_.field_search_most_m)
    passed_.pop_front();
}

double Joint::probability_near(const Pose2& map_T_base) const {
  double sum = 0;
  for (const joint::Mode& mode : bank_.modes())
    if (same_place(mode.map_T_base, map_T_base))
      sum += std::exp(mode.log_weight) * share_near(mode, map_T_base);
  return sum;
}

void Joint::judge(const Pose2& last_T_base) {
  if (bank_.modes().empty()) return;
  const Pose2& best = bank_.modes().front().map_T_base;
  const bool goes_on = candidate_ && same_place(*candidate_ * last_T_base, best);
  candidate_ = best;
  probability_ = probability_near(best);
  const double moved_m = std::hypot(last_T_base.x, last_T_base.y);
  agreed_m_ = goes_on && probability_ >= options_.localized_from ? agreed_m_ + moved_m : 0.0;
  doubted_m_ = probability_ < options_.lost_below ? doubted_m_ + moved_m : 0.0;
  if (status_ == LocalizationStatus::kLocalized) {
    if (goes_on && doubted_m_ < options_.lost_after_m) return;
    status_ = LocalizationStatus::kLost;
    ++counts_.times_lost;
  } else if (agreed_m_ >= options_.agree_m) {
    status_ = LocalizationStatus::kLocalized;
  }
}

Estimate Joint::estimate() const {
  Estimate estimate;
  if (!processed_) return estimate;
  estimate.stamp = processed_->stamp;
  estimate.travelled_m = travelled_m_;
  estimate.status = status_;
  estimate.hypotheses = places(bank_.modes());
  if (bank_.modes().empty()) return estimate;
  const joint::Mode& best = bank_.modes().front();
  estimate.probability = probability_;
  estimate.covariance = best.pose_covariance();
  if (counts_.stations > 0)
    estimate.bias_uT = rig_.base_T_magnetometer.linear().transpose() * best.state.segment<3>(joint::kBias);
  if (status_ == LocalizationStatus::kLocalized) estimate.map_T_base = best.map_T_base;
  return estimate;
}

}  // namespace mstsl
