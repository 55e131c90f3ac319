#include "mstsl/io/recording_info.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <tuple>
#include <utility>

#include "io/carmen/carmen_source.hpp"
#include "io/log/open_source.hpp"

namespace mstsl::io {
namespace {

const char* name_of(LogFormat format) {
  switch (format) {
    case LogFormat::kMcap:
      return "MCAP";
    case LogFormat::kRosbag2Folder:
      return "rosbag2 folder";
    case LogFormat::kBag:
      return "ROS 1 bag";
    case LogFormat::kCarmen:
      return "CARMEN log";
  }
  return "";
}

Result<RecordingInfo> describe_messages(const std::filesystem::path& path, LogFormat format) {
  const Result<std::unique_ptr<MessageLog>> log = open_messages(path, format);
  if (!log) return log.error();
  RecordingInfo info{name_of(format), {}, {}, {}};
  for (const Channel& channel : (*log)->channels())
    info.topics.push_back({channel.topic, channel.type, channel.message_count});
  std::ranges::sort(info.topics, {}, [](const TopicInfo& topic) { return std::tie(topic.name, topic.type); });
  if (const auto span = (*log)->time_span()) {
    info.first = span->first;
    info.last = span->last;
  }
  return info;
}

Result<RecordingInfo> describe_carmen(const std::filesystem::path& path) {
  PlayReport report;
  const Result<std::unique_ptr<EventSource>> source = open_carmen_source(path, {}, report);
  if (!source) return source.error();
  RecordingInfo info{name_of(LogFormat::kCarmen), {}, {}, {}};
  (*source)->read(
      [&info](Stamp time, const SensorEvent&) {
        info.first = info.first ? std::min(*info.first, time) : time;
        info.last = info.last ? std::max(*info.last, time) : time;
        return true;
      },
      report);
  for (const auto& [kind, count] : report.messages) info.topics.push_back({kind, kind, count});
  return info;
}

}  // namespace

bool is_recording(const std::filesystem::path& path) { return find_format(path).ok(); }

Result<RecordingInfo> describe_recording(const std::filesystem::path& path) {
  try {
    const Result<LogFormat> format = find_format(path);
    if (!format) return format.error();
    return *format == LogFormat::kCarmen ? describe_carmen(path) : describe_messages(path, *format);
  } catch (const std::bad_alloc&) {
    return Error(path.string() + ": its description needs more memory than there is");
  }
}

}  // namespace mstsl::io
