#include "io/log/open_source.hpp"

#include <utility>

#include <fmt/format.h>

#include "io/input_file.hpp"
#include "io/mcap/mcap_log.hpp"

namespace mstsl::io {

Result<std::unique_ptr<EventSource>> open_source(const std::filesystem::path& path,
                                                 const PlayOptions& options, PlayReport& report) {
  Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  if (file->size() == 0) return Error(path.string() + ": the file is empty; record it again");
  if (is_mcap(*file)) {
    Result<std::unique_ptr<MessageLog>> log = open_mcap(std::move(file).value());
    if (!log) return log.error();
    return open_ros_source(path.string(), std::move(log).value(), options, report);
  }
  return Error(path.string() +
               ": is no log that can be read: neither MCAP, nor a ROS 1 bag, nor a CARMEN log");
}

}  // namespace mstsl::io
