#include "mstsl/datasets/dataset_writer.hpp"

#include <cstddef>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording_writer.hpp"
#include "mstsl/io/truth.hpp"

namespace mstsl::datasets {
namespace {

namespace fs = std::filesystem;

std::string file_name(std::string_view kind, std::size_t number, std::string_view extension) {
  return fmt::format("{}_{:02}.{}", kind, number, extension);
}

/// A log in a folder that this conversion leaves as it is: it would be mistaken for one of these.
std::optional<std::string> foreign_log(const fs::path& folder, const Dataset& dataset) {
  static const std::regex kLogName(R"((survey|run|truth|check)_(\d{1,6})\.(mcap|csv))");
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem)) {
    const std::string name = entry.path().filename().string();
    std::smatch parts;
    if (!std::regex_match(name, parts, kLogName)) continue;
    const std::size_t number = std::stoul(parts[2]);
    const std::size_t count = parts[1] == "survey"  ? dataset.surveys.size()
                              : parts[1] == "check" ? dataset.checks.size()
                                                    : dataset.runs.size();
    if (number >= count || name != file_name(parts[1].str(), number, parts[3].str())) return name;
  }
  return std::nullopt;
}

Result<void> prepare(const fs::path& folder, const Dataset& dataset) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem) return Error(fmt::format("cannot make the folder {}: {}", folder.string(), problem.message()));
  if (const auto name = foreign_log(folder, dataset))
    return Error(fmt::format(
        "{}: it holds {}, which this conversion would leave beside its own logs; empty it or choose "
        "another folder",
        folder.string(), *name));
  return {};
}

Result<void> write_log(const Log& log, const fs::path& file, const std::string& pose_topic,
                       const std::function<void(const PoseReading&)>& truth) {
  io::Topics topics;
  topics.pose = pose_topic;
  Result<io::RecordingWriter> writer = io::RecordingWriter::open(file, log.rig, topics);
  if (!writer) return writer.error();
  Result<void> so_far;
  const auto write = [&](const SensorEvent& event) {
    if (so_far) so_far = writer->write(event);
  };
  log.play({write, [&](const PoseReading& pose) {
              if (!pose_topic.empty()) write(pose);
              if (truth) truth(pose);
            }});
  if (!so_far) return so_far;
  return writer->close();
}

Result<void> write_with_truth(const Log& log, const fs::path& file) {
  return write_log(log, file, "/ground_truth", {});
}

Result<void> write_run(const Log& log, const fs::path& folder, std::size_t number) {
  std::vector<PoseReading> truth;
  const auto keep = [&](const PoseReading& pose) { truth.push_back(pose); };
  if (const Result<void> written = write_log(log, folder / file_name("run", number, "mcap"), "", keep);
      !written)
    return written;
  return io::write_truth(truth, folder / file_name("truth", number, "csv"));
}

}  // namespace

Result<void> write_dataset(const Dataset& dataset, const fs::path& folder,
                           const std::function<bool(double)>& progress) {
  if (const Result<void> ready = prepare(folder, dataset); !ready) return ready;
  if (const Result<void> map = io::write_map(dataset.map, folder / "map.yaml"); !map) return map;
  if (const Result<void> readme = io::write_file(folder / "README.txt", dataset.provenance); !readme)
    return readme;
  std::vector<std::function<Result<void>()>> writers;
  for (std::size_t i = 0; i < dataset.surveys.size(); ++i)
    writers.push_back(
        [&, i] { return write_with_truth(dataset.surveys[i], folder / file_name("survey", i, "mcap")); });
  for (std::size_t i = 0; i < dataset.runs.size(); ++i)
    writers.push_back([&, i] { return write_run(dataset.runs[i], folder, i); });
  for (std::size_t i = 0; i < dataset.checks.size(); ++i)
    writers.push_back(
        [&, i] { return write_with_truth(dataset.checks[i], folder / file_name("check", i, "mcap")); });
  for (std::size_t i = 0; i < writers.size(); ++i) {
    if (progress && !progress(static_cast<double>(i) / static_cast<double>(writers.size())))
      return Error(fmt::format("stopped; {} holds {} of {} logs", folder.string(), i, writers.size()));
    if (const Result<void> written = writers[i](); !written) return written;
  }
  return {};
}

}  // namespace mstsl::datasets
