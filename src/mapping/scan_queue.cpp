#include "mstsl/mapping/scan_queue.hpp"

#include <utility>

#include "mstsl/scan/points.hpp"

namespace mstsl {
namespace {

constexpr double kPatience_s = 3.0;

}  // namespace

void ScanQueue::observe(const OdometryReading& odometry) {
  track_.add(odometry);
  const auto pose = track_.at(odometry.stamp);
  if (pose) odometry_.add({odometry.stamp, *pose});
}

void ScanQueue::observe(const LaserScan& scan) {
  ++scans_seen_;
  // One stamped far ahead must not keep all others out.
  if (!waiting_.empty() && waiting_.back().stamp - scan.stamp > kPatience_s) waiting_.clear();
  if (waiting_.empty() || scan.stamp > waiting_.back().stamp) waiting_.push_back(scan);
}

std::optional<PlacedScan> ScanQueue::next(bool at_the_end) {
  while (!waiting_.empty()) {
    const Stamp begin = waiting_.front().stamp, end = begin + sweep_duration_s(waiting_.front());
    const bool too_old = waiting_.back().stamp - begin > kPatience_s;
    if (!at_the_end && !too_old && !track_.covers(end)) return std::nullopt;
    LaserScan scan = std::move(waiting_.front());
    waiting_.pop_front();
    const auto track_T_base = track_.at(begin), track_T_end = track_.at(end);
    if (track_T_base) return PlacedScan{std::move(scan), *track_T_base, track_T_end.value_or(*track_T_base)};
  }
  return std::nullopt;
}

}  // namespace mstsl
