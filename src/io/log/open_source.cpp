#include "io/log/open_source.hpp"

#include <cassert>
#include <system_error>
#include <utility>

#include "io/bag/bag_log.hpp"
#include "io/carmen/carmen_source.hpp"
#include "io/input_file.hpp"
#include "io/mcap/mcap_log.hpp"
#include "io/mcap/rosbag2_folder.hpp"

namespace mstsl::io {

Result<LogFormat> find_format(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return LogFormat::kRosbag2Folder;
  const Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  if (file->size() == 0) return Error(path.string() + ": the file is empty; record it again");
  if (is_mcap(*file)) return LogFormat::kMcap;
  if (is_bag(*file)) return LogFormat::kBag;
  if (is_carmen(path)) return LogFormat::kCarmen;
  return Error(path.string() +
               ": is no log that can be read: neither MCAP, nor a ROS 1 bag, nor a CARMEN log");
}

Result<std::unique_ptr<MessageLog>> open_messages(const std::filesystem::path& path, LogFormat format) {
  assert(format != LogFormat::kCarmen);
  if (format == LogFormat::kRosbag2Folder) return open_rosbag2_folder(path);
  Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  return format == LogFormat::kMcap ? open_mcap(std::move(file).value()) : open_bag(std::move(file).value());
}

Result<std::unique_ptr<EventSource>> open_source(const std::filesystem::path& path,
                                                 const PlayOptions& options, PlayReport& report) {
  const Result<LogFormat> format = find_format(path);
  if (!format) return format.error();
  if (*format == LogFormat::kCarmen) return open_carmen_source(path, options, report);
  Result<std::unique_ptr<MessageLog>> log = open_messages(path, *format);
  if (!log) return log.error();
  return open_ros_source(path.string(), std::move(log).value(), options, report);
}

}  // namespace mstsl::io
