#include "hard_listener.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

namespace mstsl {
namespace {

constexpr std::size_t kSample = 60;  // answers kept of a run
constexpr double kTruthGap_s = 1.0;

/// Way truly driven up to each pose of the truth, m.
class Way {
 public:
  explicit Way(const Trajectory& truth) : truth_(truth), driven_m_(truth.size(), 0.0) {
    for (std::size_t i = 1; i < truth.size(); ++i)
      driven_m_[i] = driven_m_[i - 1] + counted(distance(truth[i - 1].pose, truth[i].pose));
  }
  double until(Stamp stamp) const {
    std::size_t low = 0, high = truth_.size();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      truth_[middle].stamp <= stamp ? low = middle + 1 : high = middle;
    }
    return low == 0 ? 0.0 : driven_m_[low - 1];
  }
  double whole_m() const { return driven_m_.empty() ? 0.0 : driven_m_.back(); }

 private:
  /// Being carried is no driving: no robot of ours drives 1 m between two odometry readings.
  static double counted(double step_m) { return step_m < 1.0 ? step_m : 0.0; }
  const Trajectory& truth_;
  std::vector<double> driven_m_;
};

bool is_right(const Estimate& estimate, const Pose2& truth) {
  return estimate.map_T_base && Criteria{}.success.holds(error_between(*estimate.map_T_base, truth));
}

void count_claims(const RunEvaluation& run, HardRecord& record) {
  for (const JudgedAnswer& answer : run.answers) {
    if (answer.probability >= 0.99) ++record.claims_at_99, record.wrong_at_99 += !answer.right;
    if (answer.probability >= 0.999) ++record.claims_at_999, record.wrong_at_999 += !answer.right;
  }
}

void thin(const RunEvaluation& run, HardRecord& record) {
  const std::size_t count = run.answers.size();
  const std::size_t wanted = std::min(kSample, count);
  for (std::size_t i = 0; i < wanted; ++i) record.sample.push_back(run.answers[(i + 1) * count / wanted - 1]);
}

/// Poses that were right and were withdrawn though nobody carried the robot, and the way driven rightly.
void follow(const std::vector<Estimate>& estimates, const Trajectory& truth, const Way& way,
            std::optional<Stamp> set_down, HardRecord& record) {
  bool right = false;
  double at_m = 0.0;
  Stamp last;
  for (const Estimate& estimate : estimates) {
    if (set_down && last < *set_down && estimate.stamp >= *set_down) right = false;
    last = estimate.stamp;
    const auto true_pose = truth.at(estimate.stamp, kTruthGap_s);
    if (!true_pose) {
      right = false;
      continue;
    }
    const double now_m = way.until(estimate.stamp);
    if (right) record.right_m += now_m - at_m;
    if (right && !estimate.map_T_base) ++record.false_alarms;
    right = is_right(estimate, *true_pose);
    at_m = now_m;
  }
}

KidnapOutcome after_kidnap(const std::vector<Estimate>& estimates, const Trajectory& truth, const Way& way,
                           Stamp set_down) {
  KidnapOutcome outcome;
  const double start_m = way.until(set_down);
  for (const Estimate& estimate : estimates) {
    const auto true_pose = truth.at(estimate.stamp, kTruthGap_s);
    if (!true_pose) continue;
    const bool right = is_right(estimate, *true_pose);
    if (estimate.stamp < set_down) {
      outcome.localized_before = right;
      continue;
    }
    const double driven_m = way.until(estimate.stamp) - start_m;
    if (!outcome.noticed_m && (!estimate.map_T_base || right)) outcome.noticed_m = driven_m;
    if (outcome.noticed_m && estimate.map_T_base && !right) outcome.wrong_again = true;
    if (right && !outcome.recovered_m) outcome.recovered_m = driven_m;
  }
  return outcome;
}

}  // namespace

double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

HardListener::HardListener(AnyLocalizer localizer, Traced traced)
    : traced_(traced),
      loop_(std::move(localizer), [this](const Estimate& estimate) { estimates_.push_back(estimate); }) {}

void HardListener::observe(const SensorEvent& event) {
  const double before = thread_cpu_ms();
  const std::size_t had = estimates_.size();
  loop_.observe(event);
  const double spent = thread_cpu_ms() - before;
  cpu_ms_ += spent;
  since_scan_ms_ += spent;
  if (estimates_.size() == had) return;  // passed over: its cost counts with the next scan that is not
  (estimates_.back().map_T_base ? tracking_ : searching_).add(std::exchange(since_scan_ms_, 0.0));
  if (traced_ == Traced::kNo) estimates_.back().hypotheses = {};
}

HardRecord HardListener::record(const Trajectory& truth, std::optional<Stamp> set_down) const {
  const RunEvaluation run = evaluate_run(estimates_, truth);
  const Way way(truth);
  HardRecord record;
  record.driven_m = way.whole_m();
  record.duration_s = truth.empty() ? 0.0 : truth.back().stamp - truth.front().stamp;
  record.estimates = run.estimates;
  record.answers = run.answers.size();
  count_claims(run, record);
  if (run.first()) record.first = *run.first();
  record.last = run.last;
  record.first_s = loop_.counts().time_to_fix_s;
  record.correct_distance_m = run.correct_distance_m;
  thin(run, record);
  record.times_lost = run.times_lost;
  follow(estimates_, truth, way, set_down, record);
  if (set_down) record.kidnap = after_kidnap(estimates_, truth, way, *set_down);
  record.searching = searching_;
  record.tracking = tracking_;
  return record;
}

}  // namespace mstsl
