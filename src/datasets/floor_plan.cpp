#include "mstsl/datasets/floor_plan.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/io/file_bytes.hpp"

namespace mstsl::datasets {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLimitBytes = std::size_t{1} << 26;

Result<Polygon> polygon(const Json& corners, const std::string& place) {
  if (!corners.is_array() || corners.size() < 3)
    return Error(place + " is no polygon of at least three corners");
  Polygon result;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Json& corner = corners[i];
    if (!corner.is_array() || corner.size() != 2 || !corner[0].is_number() || !corner[1].is_number())
      return Error(fmt::format("{}[{}] is no pair of numbers", place, i));
    result.emplace_back(corner[0].get<double>(), corner[1].get<double>());
    if (!result.back().allFinite()) return Error(fmt::format("{}[{}] is not finite", place, i));
  }
  return result;
}

Result<FloorPlan> floor_plan(const Json& json) {
  if (!json.is_object() || !json.contains("in") || !json.contains("out") || !json["out"].is_array())
    return Error("not a floor plan with the keys 'in' (a polygon) and 'out' (a list of polygons)");
  FloorPlan plan;
  Result<Polygon> outer = polygon(json["in"], "in");
  if (!outer) return outer.error();
  plan.outer = *std::move(outer);
  for (std::size_t i = 0; i < json["out"].size(); ++i) {
    Result<Polygon> block = polygon(json["out"][i], fmt::format("out[{}]", i));
    if (!block) return block.error();
    plan.blocks.push_back(*std::move(block));
  }
  return plan;
}

}  // namespace

Result<FloorPlan> read_floor_plan(const std::filesystem::path& file) {
  const Result<std::string> text = io::read_file(file, kLimitBytes);
  if (!text) return text.error();
  const Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded()) return Error(file.string() + ": not JSON; is the file cut off?");
  Result<FloorPlan> plan = floor_plan(json);
  if (!plan) return plan.error().within(file.string());
  return plan;
}

std::vector<sim::Segment> walls(const FloorPlan& plan) {
  std::vector<sim::Segment> walls = sim::polyline(plan.outer, true);
  for (const Polygon& block : plan.blocks)
    for (const sim::Segment& wall : sim::polyline(block, true)) walls.push_back(wall);
  return walls;
}

}  // namespace mstsl::datasets
