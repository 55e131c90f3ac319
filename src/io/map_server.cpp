#include "mstsl/io/map_server.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "file_problem.hpp"
#include "image.hpp"

namespace mstsl::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxYamlBytes = 1 << 20;
constexpr std::size_t kMaxImageBytes = std::size_t{4} << 30;
constexpr double kMaxResolution_m = 100.0;  // a slip of units, not a map
constexpr double kMaxOrigin_m = 1e8;        // projected coordinates (UTM) stay below 1e7

// What map_saver writes: 254 free, 0 occupied, 205 unknown. 205 lies just above free_thresh 0.196.
constexpr std::uint8_t kFreeSample = 254;
constexpr std::uint8_t kOccupiedSample = 0;
constexpr std::uint8_t kUnknownSample = 205;
constexpr double kOccupiedThreshold = 0.65;
constexpr double kFreeThreshold = 0.196;

enum class Mode { kTrinary, kScale, kRaw };

struct Settings {
  std::string image;
  double resolution_m = 0.0;
  Pose2 map_T_grid;
  bool negate = false;
  double occupied_threshold = kOccupiedThreshold;
  double free_threshold = kFreeThreshold;
  Mode mode = Mode::kTrinary;
};

YAML::Node need(const YAML::Node& root, const char* key) {
  const YAML::Node node = root[key];
  if (!node)
    throw FileProblem(
        "the key '{}' is missing; a map_server yaml has image, resolution, origin, negate, "
        "occupied_thresh and free_thresh",
        key);
  return node;
}

template <typename T>
T as(const YAML::Node& node, const char* key, const char* kind) {
  try {
    return node.as<T>();
  } catch (const YAML::Exception&) {
    throw FileProblem("'{}' (line {}) is not {}", key, node.Mark().line + 1, kind);
  }
}

double finite_number(const YAML::Node& node, const char* key) {
  const double value = as<double>(node, key, "a number");
  if (!std::isfinite(value))
    throw FileProblem("'{}' (line {}) is {}, not a finite number", key, node.Mark().line + 1, value);
  return value;
}

double threshold(const YAML::Node& root, const char* key) {
  const double value = finite_number(need(root, key), key);
  if (value < 0.0 || value > 1.0) throw FileProblem("'{}' is {}; it must lie between 0 and 1", key, value);
  return value;
}

Pose2 origin(const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != 3)
    throw FileProblem("'origin' (line {}) is not a list of three numbers [x, y, yaw]", node.Mark().line + 1);
  const Eigen::Vector2d position_m(finite_number(node[0], "origin"), finite_number(node[1], "origin"));
  if (position_m.cwiseAbs().maxCoeff() > kMaxOrigin_m)
    throw FileProblem("'origin' (line {}) is more than {:g} m away", node.Mark().line + 1, kMaxOrigin_m);
  return Pose2::from(position_m, finite_number(node[2], "origin"));
}

/// 0, 1, true or false: map_server asks for a number, nav2 for either.
bool flag(const YAML::Node& node, const char* key) {
  const std::string text = as<std::string>(node, key, "0 or 1");
  if (text == "0" || text == "1") return text == "1";
  return as<bool>(node, key, "0 or 1");
}

Mode mode(const YAML::Node& node) {
  if (!node) return Mode::kTrinary;
  const std::string name = as<std::string>(node, "mode", "a word");
  if (name == "trinary") return Mode::kTrinary;
  if (name == "scale") return Mode::kScale;
  if (name == "raw") return Mode::kRaw;
  throw FileProblem("'mode' is '{}'; it must be trinary, scale or raw", name);
}

Settings settings_from(const YAML::Node& root) {
  if (!root.IsMap()) throw FileProblem("this is no map_server yaml: it has no keys");
  Settings settings;
  settings.image = as<std::string>(need(root, "image"), "image", "a file name");
  if (settings.image.empty()) throw FileProblem("'image' names no file");
  settings.resolution_m = finite_number(need(root, "resolution"), "resolution");
  if (settings.resolution_m <= 0.0 || settings.resolution_m > kMaxResolution_m)
    throw FileProblem("'resolution' is {}; it must be a positive number of metres a pixel, {} at most",
                      settings.resolution_m, kMaxResolution_m);
  settings.map_T_grid = origin(need(root, "origin"));
  settings.negate = flag(need(root, "negate"), "negate");
  settings.occupied_threshold = threshold(root, "occupied_thresh");
  settings.free_threshold = threshold(root, "free_thresh");
  settings.mode = mode(root["mode"]);
  if (settings.free_threshold > settings.occupied_threshold)
    throw FileProblem("'free_thresh' {} is above 'occupied_thresh' {}", settings.free_threshold,
                      settings.occupied_threshold);
  return settings;
}

Settings parse_settings(const std::string& text) {
  try {
    return settings_from(YAML::Load(text));
  } catch (const YAML::Exception& problem) {
    throw FileProblem("line {} is not yaml: {}", problem.mark.line + 1, problem.msg);
  }
}

/// One pixel's state. `samples` are its channels, alpha the fourth.
CellState state_of(std::span<const std::uint8_t> samples, const Settings& settings) {
  const bool alpha_apart = samples.size() == 4 && settings.mode != Mode::kTrinary;
  if (alpha_apart && settings.mode == Mode::kScale && samples[3] != 255) return CellState::kUnknown;
  const std::size_t channels = alpha_apart ? 3 : samples.size();
  double sum = 0.0;
  for (std::size_t k = 0; k < channels; ++k) sum += samples[k];
  const double shade = sum / static_cast<double>(channels);
  if (settings.mode == Mode::kRaw && std::round(shade) > 100.0) return CellState::kUnknown;
  const double occupancy = settings.mode == Mode::kRaw ? std::round(shade) / 100.0
                           : settings.negate           ? shade / 255.0
                                                       : (255.0 - shade) / 255.0;
  if (occupancy > settings.occupied_threshold) return CellState::kOccupied;
  return occupancy < settings.free_threshold ? CellState::kFree : CellState::kUnknown;
}

OccupancyGrid to_grid(const Image& image, const Settings& settings) {
  OccupancyGrid grid({settings.resolution_m, image.width, image.height, settings.map_T_grid});
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::span samples(image.samples);
  for (std::size_t i = 0; i < grid.values().size(); ++i) {
    const Cell pixel = grid.geometry().cell(i);
    grid[{pixel.column, image.height - 1 - pixel.row}] =
        state_of(samples.subspan(i * channels, channels), settings);
  }
  return grid;
}

std::vector<std::string> warnings_about(const Settings& settings, const fs::path& yaml) {
  if (settings.mode == Mode::kTrinary) return {};
  return {fmt::format(
      "{}: mode {} is read as trinary: cells between free_thresh {} and occupied_thresh {} count as unknown",
      yaml.string(), settings.mode == Mode::kScale ? "scale" : "raw", settings.free_threshold,
      settings.occupied_threshold)};
}

std::string encode_settings(const std::string& image, const GridGeometry& geometry) {
  YAML::Emitter name;  // quotes where the name needs it
  name << image;
  const Pose2& origin = geometry.map_T_grid;
  return fmt::format(
      "image: {}\nmode: trinary\nresolution: {}\norigin: [{}, {}, {}]\nnegate: 0\noccupied_thresh: "
      "{}\nfree_thresh: {}\n",
      name.c_str(), geometry.resolution_m, origin.x, origin.y, origin.yaw, kOccupiedThreshold,
      kFreeThreshold);
}

Image to_image(const OccupancyGrid& grid) {
  const GridGeometry& geometry = grid.geometry();
  Image image{geometry.columns, geometry.rows, 1, {}};
  image.samples.reserve(geometry.size());
  for (int row = geometry.rows - 1; row >= 0; --row)
    for (int column = 0; column < geometry.columns; ++column) {
      const CellState state = grid[{column, row}];
      image.samples.push_back(state == CellState::kFree       ? kFreeSample
                              : state == CellState::kOccupied ? kOccupiedSample
                                                              : kUnknownSample);
    }
  return image;
}

}  // namespace

Result<MapFile> read_map_file(const fs::path& yaml) {
  const Result<std::string> text = read_file(yaml, kMaxYamlBytes);
  if (!text) return text.error();
  const Result<Settings> settings = guarded(yaml, [&] { return parse_settings(*text); });
  if (!settings) return settings.error();
  MapFile map;
  map.image = yaml.parent_path() / settings->image;  // an absolute image path stands for itself
  const Result<std::string> bytes = read_file(map.image, kMaxImageBytes);
  if (!bytes)
    return Error(fmt::format("{}: 'image' points to a file that cannot be used: {}", yaml.string(),
                             bytes.error().message()));
  Result<OccupancyGrid> grid = guarded(map.image, [&] { return to_grid(decode_image(*bytes), *settings); });
  if (!grid) return grid.error();
  map.grid = *std::move(grid);
  if (count(map.grid, CellState::kFree) == 0)
    return Error(fmt::format("{}: the map has no free cell; check 'negate' ({}) and 'free_thresh' ({})",
                             yaml.string(), settings->negate ? 1 : 0, settings->free_threshold));
  map.warnings = warnings_about(*settings, yaml);
  return map;
}

Result<OccupancyGrid> read_map(const fs::path& yaml) {
  Result<MapFile> map = read_map_file(yaml);
  if (!map) return map.error();
  return std::move(map->grid);
}

Result<void> write_map(const OccupancyGrid& grid, const fs::path& yaml) {
  if (yaml.extension() != ".yaml" && yaml.extension() != ".yml")
    return Error(fmt::format("cannot write the map {}: its name must end in .yaml", yaml.string()));
  if (grid.values().empty())
    return Error(fmt::format("cannot write the map {}: it has no cells", yaml.string()));
  const fs::path image = fs::path(yaml).replace_extension(".pgm");
  // The image first: whoever sees the yaml finds what it names.
  if (const Result<void> written = write_file(image, encode_pgm(to_image(grid))); !written) return written;
  return write_file(yaml, encode_settings(image.filename().string(), grid.geometry()));
}

}  // namespace mstsl::io
