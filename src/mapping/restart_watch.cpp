#include "mstsl/mapping/restart_watch.hpp"

#include <numeric>

namespace mstsl {
namespace {

template <typename Readings>
Eigen::Vector3d mean(const Readings& readings) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  return std::accumulate(readings.begin(), readings.end(), none) / static_cast<double>(readings.size());
}

}  // namespace

void RestartWatch::observe(const FieldReading& reading) {
  // Unrelated places differ by some 20 uT (5 to 13 uT an axis); 5 cm beside a post by 2.
  constexpr double kChange_uT = 5.0;
  if (!reading.sensor_field_uT.allFinite()) return;
  if (!after_) {
    before_.push_back(reading.sensor_field_uT);
    if (before_.size() > kReadings) before_.pop_front();
    return;
  }
  after_->push_back(reading.sensor_field_uT);
  if (after_->size() < kReadings) return;
  if (!before_.empty()) {
    const double change_uT = (mean(*after_) - mean(before_)).norm();
    if (change_uT > kChange_uT) jumps_.push_back({reading.stamp, change_uT});
  }
  before_.assign(after_->begin(), after_->end());
  after_.reset();
}

}  // namespace mstsl
