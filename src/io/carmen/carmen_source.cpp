#include "io/carmen/carmen_source.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "mstsl/core/angles.hpp"

#include "io/carmen/lines.hpp"
#include "io/carmen/odometry.hpp"
#include "io/carmen/parse.hpp"

namespace mstsl::io {
namespace {

/// What the logs write for "no return" is 50, 81.83 or 81.91 m, by laser and setting; indoors nothing true is
/// as far.
constexpr double kLargestRange_m = 49.9;

/// A clock that stutters by less than this keeps the order of the lines (Intel's runs back by up to 0.9 s,
/// while its poses go on smoothly); one that runs back further was set.
constexpr double kLargestStutter_s = 10.0;
constexpr std::int64_t kTick_ns = 1000;

/// The laser looks over 180 degrees in steps of 1 or 0.5. Logs of 181 or 361 beams have them all; those of
/// 180 or 360 lack the last: spread so, maps from corrected poses have 3 to 9 % fewer occupied cells than
/// when the beams are stretched over the whole half circle (Aces, Intel, Freiburg), and for 361 it is the
/// other way round (Seattle).
double beam_step(std::size_t beams) {
  const std::size_t steps = beams % 2 == 0 || beams == 1 ? beams : beams - 1;
  return kPi / static_cast<double>(steps);
}

/// Gives lines stamps that never run back, and never stand still for one kind of line.
class LineClock {
 public:
  Stamp stamp(double time_s, Stamp& last_of_kind, PlayReport& report) {
    Stamp stamp = Stamp::from_seconds(time_s);
    const bool was_set = last_ - stamp > kLargestStutter_s;
    const Stamp earliest{std::max(last_.ns, last_of_kind.ns + kTick_ns)};
    if (!was_set && stamp < earliest) {
      ++report.problems["times that stand still or run back, moved behind the line before"];
      stamp = earliest;
    }
    return last_ = last_of_kind = stamp;
  }

 private:
  Stamp last_{std::numeric_limits<std::int64_t>::min() / 4};
};

class CarmenSource final : public EventSource {
 public:
  CarmenSource(std::filesystem::path path, Topics topics)
      : name_(path.string()), path_(std::move(path)), topics_(std::move(topics)) {}

  const std::string& name() const override { return name_; }
  const Rig& rig() const override { return rig_; }
  void read(const Take& take, PlayReport& report) override;

 private:
  std::string name_;
  std::filesystem::path path_;
  Topics topics_;
  Rig rig_;  ///< the logged pose is the laser's, so laser and base are one
};

/// One reading of the log.
class Reading {
 public:
  Reading(const Topics& topics, const EventSource::Take& take, PlayReport& report)
      : topics_(topics), take_(take), report_(report) {}

  bool line(const carmen::OdometryLine& line) {
    ++report_.messages["ODOM"];
    const std::optional<Pose2> pose = odometry_.at_odometry(line.pose);
    if (!pose) return true;
    const Stamp stamp = clock_.stamp(line.time_s, last_odometry_, report_);
    return topics_.odometry.empty() || take_(stamp, OdometryReading{stamp, *pose});
  }

  bool line(carmen::ScanLine line) {
    ++report_.messages["FLASER"];
    odometry_.at_scan(line.pose);
    const Stamp stamp = clock_.stamp(line.time_s, last_scan_, report_);
    if (!topics_.pose.empty() && !take_(stamp, PoseReading{stamp, line.pose})) return false;
    if (topics_.scan.empty()) return true;
    if (line.ranges_m.empty()) ++report_.problems["scans without beams dropped"];
    if (line.ranges_m.empty()) return true;
    const double step_rad = beam_step(line.ranges_m.size());
    return take_(stamp,
                 LaserScan{stamp, -0.5 * kPi, step_rad, 0.0, 0.0, kLargestRange_m, std::move(line.ranges_m)});
  }

  bool line(carmen::OtherLine) { return true; }
  bool line(carmen::DamagedLine) {
    ++report_.problems["damaged lines dropped"];
    return true;
  }

 private:
  const Topics& topics_;
  const EventSource::Take& take_;
  PlayReport& report_;
  carmen::WheelOdometry odometry_;
  LineClock clock_;
  Stamp last_odometry_{std::numeric_limits<std::int64_t>::min() / 4};
  Stamp last_scan_{std::numeric_limits<std::int64_t>::min() / 4};
};

void CarmenSource::read(const Take& take, PlayReport& report) {
  Result<carmen::Lines> lines = carmen::Lines::open(path_);
  if (!lines) return report.warnings.push_back(lines.error().message());
  Reading reading(topics_, take, report);
  while (const std::optional<std::string> text = lines->next()) {
    carmen::Line line = carmen::parse_line(*text);
    if (!std::visit([&reading](auto& parsed) { return reading.line(std::move(parsed)); }, line)) return;
  }
  if (lines->is_damaged())
    report.warnings.push_back(
        name_ + ": the compressed log ends in the middle; it was played to its last whole line");
}

bool has_scan(carmen::Lines lines) {
  while (const std::optional<std::string> text = lines.next())
    if (std::holds_alternative<carmen::ScanLine>(carmen::parse_line(*text))) return true;
  return false;
}

}  // namespace

bool is_carmen(const std::filesystem::path& path) {
  constexpr int kLinesLookedAt = 64;
  Result<carmen::Lines> lines = carmen::Lines::open(path);
  for (int i = 0; lines && i < kLinesLookedAt; ++i) {
    const std::optional<std::string> line = lines->next();
    if (!line) return false;
    if (carmen::is_typical(*line)) return true;
  }
  return false;
}

Result<std::unique_ptr<EventSource>> open_carmen_source(const std::filesystem::path& path,
                                                        const PlayOptions& options, PlayReport& report) {
  Result<carmen::Lines> lines = carmen::Lines::open(path);
  if (!lines) return lines.error();
  if (!has_scan(std::move(lines).value()))
    return Error(path.string() +
                 ": the CARMEN log holds no whole FLASER line, the only kind of scan that is read");
  if (!options.topics.magnetic_field.empty())
    report.warnings.push_back(path.string() + ": a CARMEN log holds no magnetic field");
  return std::unique_ptr<EventSource>(std::make_unique<CarmenSource>(path, options.topics));
}

}  // namespace mstsl::io
