#include "turns.hpp"

#include <array>
#include <cmath>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

constexpr double kMaxOdometryGap_s = 0.5;
/// A robot that moved this far without turning through more than two headings is still driving to its place.
constexpr double kArrival_m = 0.05;
constexpr int kArrivalHeadings = 3;

/// A turn in the making.
class OpenTurn {
 public:
  /// False: this pose belongs to another place.
  bool reaches(const Pose2& pose, double place_m) const {
    const double moved_m = distance(start_, pose);
    return moved_m <= (headings_ < kArrivalHeadings ? kArrival_m : place_m);
  }
  void begin(const Pose2& pose) { *this = OpenTurn(pose); }

  void add(double heading_rad, const Eigen::Vector3d& base_field_uT) {
    const double share = (wrap_angle(heading_rad) + kPi) / (2.0 * kPi);
    const int heading = std::min(static_cast<int>(share * kHeadings), kHeadings - 1);
    TurnSample& sample = samples_[static_cast<std::size_t>(heading)];
    if (sample.readings == 0) ++headings_;
    sample.heading = heading;
    sample.base_field_uT += base_field_uT;
    ++sample.readings;
  }

  double covered_rad() const { return headings_ * 2.0 * kPi / kHeadings; }

  void append_to(std::vector<TurnSample>& all, std::size_t turn) const {
    for (TurnSample sample : samples_) {
      if (sample.readings == 0) continue;
      sample.base_field_uT /= static_cast<double>(sample.readings);
      sample.turn = turn;
      all.push_back(sample);
    }
  }

  OpenTurn() = default;

 private:
  explicit OpenTurn(const Pose2& start) : start_(start) {}
  Pose2 start_;
  std::array<TurnSample, kHeadings> samples_{};
  int headings_ = 0;
};

}  // namespace

void find_turns(const Trajectory& odom_T_base, std::span<const FieldReading> readings,
                const Eigen::Matrix3d& base_R_sensor, const TurnCalibrationOptions& options,
                std::vector<TurnSample>& samples, std::size_t& turns) {
  OpenTurn open;
  const auto close = [&] {
    if (open.covered_rad() >= options.covered_rad) open.append_to(samples, turns++);
  };
  for (const FieldReading& reading : readings) {
    const auto pose = odom_T_base.at(reading.stamp, kMaxOdometryGap_s);
    if (!pose || !reading.sensor_field_uT.allFinite()) continue;
    if (!open.reaches(*pose, options.place_m)) {
      close();
      open.begin(*pose);
    }
    open.add(pose->yaw, base_R_sensor * reading.sensor_field_uT);
  }
  close();
}

}  // namespace mstsl
