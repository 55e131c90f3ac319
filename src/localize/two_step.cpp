#include "mstsl/localize/two_step.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace mstsl {
namespace {

constexpr double kFieldWithScan_s = 0.1;  // at walking pace 0.1 m: less than the field's correlation length
constexpr std::size_t kMostHypotheses = 20;  // as many as an estimate lists

/// Best first; those that were removed are left out.
std::vector<Hypothesis> listed(const std::vector<LidarHypothesis>& hypotheses,
                               const std::vector<double>& weights) {
  std::vector<Hypothesis> list;
  for (std::size_t i = 0; i < hypotheses.size(); ++i)
    if (!hypotheses[i].rejected) list.push_back({hypotheses[i].map_T_base, weights[i]});
  std::stable_sort(list.begin(), list.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.weight > b.weight; });
  if (list.size() > kMostHypotheses) list.resize(kMostHypotheses);
  return list;
}

}  // namespace

TwoStep::TwoStep(std::shared_ptr<const LocalizationMaps> maps, const Rig& rig, const TwoStepOptions& options)
    : maps_(std::move(maps)),
      rig_(rig),
      options_(options),
      random_(options.seed),
      track_(options.odometry),
      phase_(Gathering{FirstReading(options.align)}) {}

void TwoStep::observe(const FieldReading& field) {
  if (!field.sensor_field_uT.allFinite() || (last_field_ && field.stamp <= *last_field_)) {
    ++counts_.bad_field;
    return;
  }
  last_field_ = field.stamp;
  last_base_field_uT_ = rig_.base_T_magnetometer.linear() * field.sensor_field_uT;
  const std::optional<Pose2> track_T_base = track_.at(field.stamp);
  if (!track_T_base) {
    ++counts_.field_without_odometry;
    return;
  }
  ++counts_.field_used;
  if (auto* gathering = std::get_if<Gathering>(&phase_))
    gathering->reading.observe_field(field.stamp, last_base_field_uT_, *track_T_base);
}

void TwoStep::observe(const LaserScan& scan) {
  if (last_scan_ && scan.stamp <= *last_scan_) {
    ++counts_.late_scans;
    return;
  }
  last_scan_ = scan.stamp;
  const std::optional<Pose2> track_T_base = track_.at(scan.stamp);
  if (!track_T_base) {
    ++counts_.scans_without_odometry;
    return;
  }
  if (!worth_processing(scan.stamp, *track_T_base)) return;
  Step step = make_step(scan, *track_T_base);
  if (step.returns.size() < options_.min_returns) {
    ++counts_.blind_scans;
    step.returns.clear();
  }
  advance(step);
  last_step_ = {step.stamp, step.track_T_base};
  breaks_at_last_step_ = track_.breaks();
  travelled_at_last_step_m_ = track_.travelled_m();
}

bool TwoStep::worth_processing(Stamp stamp, const Pose2& track_T_base) const {
  if (!last_step_) return true;
  return distance(last_step_->pose, track_T_base) >= options_.process_every_m ||
         std::abs(angle_between(last_step_->pose.yaw, track_T_base.yaw)) >= options_.process_every_rad ||
         stamp - last_step_->stamp >= options_.process_every_s;
}

TwoStep::Step TwoStep::make_step(const LaserScan& scan, const Pose2& track_T_base) const {
  const std::optional<Pose2> track_T_end = track_.at(scan.stamp + sweep_duration_s(scan));
  const Pose2 first_T_last = track_T_end ? between(track_T_base, *track_T_end) : Pose2{};
  return {scan.stamp, track_T_base, last_step_ ? between(last_step_->pose, track_T_base) : Pose2{},
          last_step_ && track_.breaks() != breaks_at_last_step_,
          beam_returns(scan, rig_.base_T_laser, first_T_last)};
}

void TwoStep::advance(const Step& step) {
  if (auto* gathering = std::get_if<Gathering>(&phase_)) return advance(*gathering, step);
  if (auto* comparing = std::get_if<Comparing>(&phase_)) return advance(*comparing, step);
  advance(std::get<Tracking>(phase_), step);
}

void TwoStep::advance(Gathering& gathering, const Step& step) {
  if (step.broken) return search_again();
  if (step.returns.empty()) return;
  gathering.reading.observe_scan(step.stamp, end_points(step.returns), step.track_T_base, random_);
  const std::optional<AlignedReading> reading = gathering.reading.take();
  if (!reading) return;
  const auto hypotheses = initialise(*maps_->field, maps_->building_axis_rad, *reading,
                                     rig_.base_T_magnetometer, options_.initialise);
  if (hypotheses.empty()) return search_again();
  ++counts_.searches;
  phase_ = Comparing{
      LidarStage(maps_, hypotheses, between(reading->track_T_base, step.track_T_base), options_.lidar)};
}

void TwoStep::advance(Comparing& comparing, const Step& step) {
  if (step.broken) return search_again();
  const std::vector<LidarHypothesis> before = comparing.stage.hypotheses();
  comparing.stage.observe(step.returns, step.last_T_base);
  count_removed(before, comparing.stage.hypotheses());
  if (comparing.stage.all_rejected()) {
    ++counts_.all_rejected;
    return search_again();
  }
  if (const std::optional<LidarStage::Answer> answer = comparing.stage.answer()) {
    was_localized_ = true;
    phase_ = Tracking{Tracker(maps_, answer->map_T_base, answer->covariance, options_.tracker),
                      answer->probability, FieldWitness(options_.field_witness)};
  }
}

void TwoStep::advance(Tracking& tracking, const Step& step) {
  tracking.tracker.observe(end_points(step.returns), step.last_T_base, step.broken);
  ask_field(tracking, step.stamp);
  if (!tracking.tracker.lost(tracking.field.agrees())) return;
  ++counts_.times_lost;
  search_again();
}

void TwoStep::ask_field(Tracking& tracking, Stamp stamp) const {
  if (!last_field_ || std::abs(stamp - *last_field_) > kFieldWithScan_s) return;
  tracking.field.observe(maps_->field_cells, last_base_field_uT_, tracking.tracker.map_T_base(),
                         rig_.base_T_magnetometer.translation().head<2>());
}

void TwoStep::search_again() { phase_ = Gathering{FirstReading(options_.align)}; }

void TwoStep::count_removed(const std::vector<LidarHypothesis>& before,
                            const std::vector<LidarHypothesis>& after) {
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after[i].rejected && !before[i].rejected)
      ++counts_.removed[static_cast<std::size_t>(*after[i].rejected)];
}

Estimate TwoStep::estimate() const {
  Estimate estimate;
  if (!last_step_) return estimate;
  estimate.stamp = last_step_->stamp;
  estimate.travelled_m = travelled_at_last_step_m_;
  estimate.status = was_localized_ ? LocalizationStatus::kLost : LocalizationStatus::kSearching;
  if (const auto* comparing = std::get_if<Comparing>(&phase_))
    estimate.hypotheses = listed(comparing->stage.hypotheses(), comparing->stage.weights());
  if (const auto* tracking = std::get_if<Tracking>(&phase_)) {
    estimate.status = LocalizationStatus::kLocalized;
    estimate.map_T_base = tracking->tracker.map_T_base();
    estimate.covariance = tracking->tracker.covariance();
    estimate.probability = tracking->probability;
    estimate.hypotheses = {{*estimate.map_T_base, tracking->probability}};
  }
  return estimate;
}

const std::vector<LidarHypothesis>* TwoStep::hypotheses() const {
  const auto* comparing = std::get_if<Comparing>(&phase_);
  return comparing ? &comparing->stage.hypotheses() : nullptr;
}

}  // namespace mstsl
