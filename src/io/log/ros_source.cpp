#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "mstsl/magnetic/unit.hpp"

#include "io/log/event_source.hpp"
#include "io/log/frame_tree.hpp"
#include "io/log/ros_events.hpp"
#include "io/log/topic_check.hpp"

namespace mstsl::io {
namespace {

/// Half a second of a usual magnetometer; enough for a median that a few start-up readings do not move.
constexpr std::size_t kReadingsForUnit = 50;

class RosSource final : public EventSource {
 public:
  RosSource(std::string name, std::unique_ptr<MessageLog> log, Topics topics, SensorSetup setup, Rig rig)
      : name_(std::move(name)),
        log_(std::move(log)),
        topics_(std::move(topics)),
        setup_(std::move(setup)),
        rig_(rig) {}

  const std::string& name() const override { return name_; }
  const Rig& rig() const override { return rig_; }

  void read(const Take& take, PlayReport& report) override {
    RosEvents events(topics_, setup_, report);
    const auto wanted = [this](const Channel& channel) {
      const std::string& topic = channel.topic;
      return !topic.empty() && (topic == topics_.scan || topic == topics_.magnetic_field ||
                                topic == topics_.odometry || topic == topics_.imu || topic == topics_.pose);
    };
    const auto visit = [&](const RawMessage& message) {
      std::optional<SensorEvent> event = events.make(message);
      return !event || take(message.log_time, *std::move(event));
    };
    log_->read(wanted, visit, &report);
  }

 private:
  std::string name_;
  std::unique_ptr<MessageLog> log_;
  Topics topics_;
  SensorSetup setup_;
  Rig rig_;
};

/// What the first messages of the sensors say.
struct FirstMessages {
  std::string scan_frame, magnetic_frame, imu_frame;
  std::vector<double> field_norms;
};

/// Reads on until each wanted sensor that has messages has been seen often enough.
FirstMessages look_ahead(MessageLog& log, const Topics& topics) {
  FirstMessages first;
  const auto has_messages = [&log](const std::string& topic) {
    return std::ranges::any_of(log.channels(), [&topic](const Channel& channel) {
      return !topic.empty() && channel.topic == topic && channel.message_count > 0;
    });
  };
  bool needs_scan = has_messages(topics.scan);
  bool needs_imu = has_messages(topics.imu);
  bool needs_field = has_messages(topics.magnetic_field);
  const auto wanted = [&](const Channel& channel) {
    return (needs_scan && channel.topic == topics.scan) || (needs_imu && channel.topic == topics.imu) ||
           (needs_field && channel.topic == topics.magnetic_field);
  };
  const auto visit = [&](const RawMessage& message) {
    const ros::Encoding encoding = message.channel->encoding;
    if (needs_scan && message.channel->topic == topics.scan) {
      const auto scan = ros::decode<ros::LaserScan>(encoding, message.data);
      if (scan) first.scan_frame = frame_name(scan->header.frame_id);
      needs_scan = !scan;
    } else if (needs_imu && message.channel->topic == topics.imu) {
      const auto imu = ros::decode<ros::Imu>(encoding, message.data);
      if (imu) first.imu_frame = frame_name(imu->header.frame_id);
      needs_imu = !imu;
    } else if (needs_field && message.channel->topic == topics.magnetic_field) {
      if (const auto field = ros::decode<ros::MagneticField>(encoding, message.data)) {
        if (first.field_norms.empty()) first.magnetic_frame = frame_name(field->header.frame_id);
        const ros::Vector3& b = field->magnetic_field;
        first.field_norms.push_back(std::hypot(b.x, b.y, b.z));
      }
      needs_field = first.field_norms.size() < kReadingsForUnit;
    }
    return needs_scan || needs_imu || needs_field;
  };
  log.read(wanted, visit, nullptr);
  return first;
}

FrameTree read_static_transforms(MessageLog& log, const std::string& topic, PlayReport& report) {
  FrameTree tree;
  const auto wanted = [&topic](const Channel& channel) { return !topic.empty() && channel.topic == topic; };
  const auto visit = [&](const RawMessage& message) {
    const auto transforms = ros::decode<ros::TFMessage>(message.channel->encoding, message.data);
    if (!transforms) ++report.problems["static transforms that are cut short dropped"];
    if (!transforms) return true;
    for (const ros::TransformStamped& transform : transforms->transforms) {
      const auto motion = to_isometry(transform.translation, transform.rotation);
      if (!motion) ++report.problems["static transforms that are no rigid motion dropped"];
      if (motion) tree.add(transform.header.frame_id, transform.child_frame_id, *motion);
    }
    return true;
  };
  log.read(wanted, visit, nullptr);
  return tree;
}

/// The way of finding mountings that never keeps silent when there is none.
class Mountings {
 public:
  Mountings(const std::string& log_name, const FrameTree& tree, const Topics& topics, PlayReport& report)
      : log_name_(log_name), tree_(tree), topics_(topics), report_(report) {}

  Eigen::Isometry3d find(const std::string& to, const std::string& from, std::string_view sensor) const {
    if (const auto found = tree_.find(to, from)) return *found;
    const std::vector<std::string> frames = tree_.frames();
    report_.warnings.push_back(
        fmt::format("{}: {} gives no way from '{}' to '{}' (frames there: {}), so the {} is TAKEN TO SIT "
                    "EXACTLY AT '{}'; record {} or "
                    "name the right frame",
                    log_name_, topics_.transforms_static.empty() ? "no topic" : topics_.transforms_static, to,
                    from, frames.empty() ? "none" : fmt::format("{}", fmt::join(frames, ", ")), sensor, to,
                    topics_.transforms_static.empty() ? "/tf_static" : topics_.transforms_static));
    return Eigen::Isometry3d::Identity();
  }

 private:
  const std::string& log_name_;
  const FrameTree& tree_;
  const Topics& topics_;
  PlayReport& report_;
};

Result<double> find_unit(const std::string& log_name, const std::vector<double>& norms,
                         const std::string& topic, PlayReport& report) {
  const Result<FieldUnit> unit = detect_unit(norms);
  if (!unit) return unit.error().within(fmt::format("{}: topic {}", log_name, topic));
  if (*unit != FieldUnit::kTesla)
    report.warnings.push_back(fmt::format(
        "{}: topic {} should be in tesla, but its values are taken to be {}{}", log_name, topic,
        to_string(*unit),
        *unit == FieldUnit::kNormalised ? " (as multiples of 50 uT: its true strength is unknown)" : ""));
  return microtesla_per(*unit);
}

}  // namespace

Result<std::unique_ptr<EventSource>> open_ros_source(std::string name, std::unique_ptr<MessageLog> log,
                                                     const PlayOptions& options, PlayReport& report) {
  const Topics& topics = options.topics;
  if (const Result<void> checked = check_topics(name, log->channels(), topics); !checked)
    return checked.error();
  FirstMessages first = look_ahead(*log, topics);
  SensorSetup setup{first.scan_frame, first.magnetic_frame, first.imu_frame};
  if (!topics.magnetic_field.empty()) {
    const Result<double> unit = find_unit(name, first.field_norms, topics.magnetic_field, report);
    if (!unit) return unit.error();
    setup.microtesla_per_unit = *unit;
  }
  const FrameTree tree = read_static_transforms(*log, topics.transforms_static, report);
  const Mountings mountings(name, tree, topics, report);
  const std::string base(frame_name(options.base_frame));
  Rig rig;
  if (!topics.scan.empty()) rig.base_T_laser = mountings.find(base, first.scan_frame, "laser");
  if (!topics.magnetic_field.empty())
    rig.base_T_magnetometer = mountings.find(base, first.magnetic_frame, "magnetometer");
  if (!first.imu_frame.empty() && !first.magnetic_frame.empty())
    setup.magnetometer_q_imu =
        Eigen::Quaterniond(mountings.find(first.magnetic_frame, first.imu_frame, "inertial unit").rotation());
  return std::unique_ptr<EventSource>(
      std::make_unique<RosSource>(std::move(name), std::move(log), topics, std::move(setup), rig));
}

}  // namespace mstsl::io
