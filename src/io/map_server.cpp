#include "mstsl/io/map_server.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "file_problem.hpp"
#include "image.hpp"
#include "map_settings.hpp"

namespace mstsl::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxYamlBytes = 1 << 20;
constexpr std::size_t kMaxImageBytes = std::size_t{4} << 30;

// What map_saver writes: 254 free, 0 occupied, 205 unknown. 205 lies just above free_thresh 0.196.
constexpr std::uint8_t kFreeSample = 254;
constexpr std::uint8_t kOccupiedSample = 0;
constexpr std::uint8_t kUnknownSample = 205;

/// One pixel's state. `samples` are its channels, alpha the fourth.
CellState state_of(std::span<const std::uint8_t> samples, const MapSettings& settings) {
  const bool alpha_apart = samples.size() == 4 && settings.mode != MapMode::kTrinary;
  if (alpha_apart && settings.mode == MapMode::kScale && samples[3] != 255) return CellState::kUnknown;
  const std::size_t channels = alpha_apart ? 3 : samples.size();
  double sum = 0.0;
  for (std::size_t k = 0; k < channels; ++k) sum += samples[k];
  const double shade = sum / static_cast<double>(channels);
  if (settings.mode == MapMode::kRaw && std::round(shade) > 100.0) return CellState::kUnknown;
  const double occupancy = settings.mode == MapMode::kRaw ? std::round(shade) / 100.0
                           : settings.negate              ? shade / 255.0
                                                          : (255.0 - shade) / 255.0;
  if (occupancy > settings.occupied_threshold) return CellState::kOccupied;
  return occupancy < settings.free_threshold ? CellState::kFree : CellState::kUnknown;
}

OccupancyGrid to_grid(const Image& image, const MapSettings& settings) {
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

std::vector<std::string> warnings_about(const MapSettings& settings, const fs::path& yaml) {
  if (settings.mode == MapMode::kTrinary) return {};
  return {fmt::format(
      "{}: mode {} is read as trinary: cells between free_thresh {} and occupied_thresh {} count as unknown",
      yaml.string(), settings.mode == MapMode::kScale ? "scale" : "raw", settings.free_threshold,
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
  const Result<MapSettings> settings = guarded(yaml, [&] { return parse_map_settings(*text); });
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
