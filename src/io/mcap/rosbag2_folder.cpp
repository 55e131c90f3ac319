#include "io/mcap/rosbag2_folder.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "io/input_file.hpp"
#include "io/log/sequence_log.hpp"
#include "io/mcap/mcap_log.hpp"

namespace mstsl::io {
namespace fs = std::filesystem;
namespace {

using Files = std::vector<fs::path>;

std::string text_at(const YAML::Node& node, const char* key) {
  const YAML::Node value = node[key];
  return value && value.IsScalar() ? value.as<std::string>() : std::string();
}

Result<Files> files_in(const YAML::Node& metadata, const fs::path& folder) {
  const YAML::Node bag = metadata["rosbag2_bagfile_information"];
  if (!bag || !bag.IsMap())
    return Error("has no rosbag2_bagfile_information; make it anew with 'ros2 bag reindex'");
  if (const std::string storage = text_at(bag, "storage_identifier"); storage != "mcap")
    return Error(fmt::format(
        "its storage is '{}', but only mcap is read; convert the bag with 'ros2 bag convert'", storage));
  if (const std::string mode = text_at(bag, "compression_mode");
      !mode.empty() && mode != "none" && mode != "NONE")
    return Error(fmt::format(
        "the bag is compressed by rosbag2 itself (compression_mode: {}), which is not read; convert it "
        "with 'ros2 bag convert' to MCAP's own compression",
        mode));
  Files files;
  for (const YAML::Node& file : bag["relative_file_paths"]) {
    // Early rosbag2 wrote the folder's name before the file's; the files always lie beside metadata.yaml.
    files.push_back(folder / fs::path(file.as<std::string>()).filename());
  }
  return files;
}

Result<Files> files_by_metadata(const fs::path& metadata) {
  try {
    return files_in(YAML::LoadFile(metadata.string()), metadata.parent_path());
  } catch (const YAML::Exception& exception) {
    return Error(fmt::format("cannot be read as YAML: {}", exception.what()));
  }
}

Files mcap_files_in(const fs::path& folder) {
  Files files;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    if (ignored) break;
    if (entry->path().extension() == ".mcap") files.push_back(entry->path());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

Result<std::unique_ptr<MessageLog>> open_rosbag2_folder(const fs::path& folder) {
  std::error_code ignored;
  const fs::path metadata = folder / "metadata.yaml";
  Files files;
  if (fs::exists(metadata, ignored)) {
    Result<Files> named = files_by_metadata(metadata);
    if (!named) return named.error().within(metadata.string());
    files = std::move(named).value();
  } else {
    files = mcap_files_in(folder);
  }
  if (files.empty())
    return Error(fmt::format(
        "{}: is a folder without MCAP files; name a log, or the folder that 'ros2 bag record -s mcap' made",
        folder.string()));
  std::vector<std::unique_ptr<MessageLog>> parts;
  for (const fs::path& path : files) {
    Result<InputFile> file = InputFile::open(path);
    if (!file) return file.error().within(folder.string());
    Result<std::unique_ptr<MessageLog>> part = open_mcap(std::move(file).value());
    if (!part) return part.error();
    parts.push_back(std::move(part).value());
  }
  return std::unique_ptr<MessageLog>(std::make_unique<SequenceLog>(std::move(parts)));
}

}  // namespace mstsl::io
