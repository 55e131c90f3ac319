#include "map_settings.hpp"

#include "yaml_values.hpp"

namespace mstsl::io {
namespace {

constexpr double kMaxResolution_m = 100.0;  // a slip of units, not a map
constexpr double kMaxOrigin_m = 1e8;        // projected coordinates (UTM) stay below 1e7

YAML::Node need(const YAML::Node& root, const char* key) {
  const YAML::Node node = root[key];
  if (!node)
    throw FileProblem(
        "the key '{}' is missing; a map_server yaml has image, resolution, origin, negate, "
        "occupied_thresh and free_thresh",
        key);
  return node;
}

double threshold(const YAML::Node& root, const char* key) {
  const double value = yaml_finite_number(need(root, key), key);
  if (value < 0.0 || value > 1.0) throw FileProblem("'{}' is {}; it must lie between 0 and 1", key, value);
  return value;
}

Pose2 origin(const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != 3)
    throw FileProblem("'origin' (line {}) is not a list of three numbers [x, y, yaw]", node.Mark().line + 1);
  const Eigen::Vector2d position_m(yaml_finite_number(node[0], "origin"),
                                   yaml_finite_number(node[1], "origin"));
  if (position_m.cwiseAbs().maxCoeff() > kMaxOrigin_m)
    throw FileProblem("'origin' (line {}) is more than {:g} m away", node.Mark().line + 1, kMaxOrigin_m);
  return Pose2::from(position_m, yaml_finite_number(node[2], "origin"));
}

/// 0, 1, true or false: map_server asks for a number, nav2 for either.
bool flag(const YAML::Node& node, const char* key) {
  const std::string text = yaml_as<std::string>(node, key, "0 or 1");
  if (text == "0" || text == "1") return text == "1";
  return yaml_as<bool>(node, key, "0 or 1");
}

MapMode mode(const YAML::Node& node) {
  if (!node) return MapMode::kTrinary;
  const std::string name = yaml_as<std::string>(node, "mode", "a word");
  if (name == "trinary") return MapMode::kTrinary;
  if (name == "scale") return MapMode::kScale;
  if (name == "raw") return MapMode::kRaw;
  throw FileProblem("'mode' is '{}'; it must be trinary, scale or raw", name);
}

MapSettings settings_from(const YAML::Node& root) {
  if (!root.IsMap()) throw FileProblem("this is no map_server yaml: it has no keys");
  MapSettings settings;
  settings.image = yaml_as<std::string>(need(root, "image"), "image", "a file name");
  if (settings.image.empty()) throw FileProblem("'image' names no file");
  settings.resolution_m = yaml_finite_number(need(root, "resolution"), "resolution");
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

}  // namespace

MapSettings parse_map_settings(const std::string& text) { return parse_yaml(text, settings_from); }

}  // namespace mstsl::io
