#include "mstsl/magnetic/field_map.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace mstsl {
namespace {

constexpr std::array<std::pair<FieldModel, std::string_view>, 3> kNames{
    {{FieldModel::kGpr, "gpr"},
     {FieldModel::kBilinear, "bilinear"},
     {FieldModel::kFingerprint, "fingerprint"}}};

}  // namespace

std::string_view to_string(FieldModel model) {
  for (const auto& [value, name] : kNames)
    if (value == model) return name;
  return "unknown";
}

std::optional<FieldModel> field_model_from(std::string_view name) {
  for (const auto& [value, its_name] : kNames)
    if (its_name == name) return value;
  return std::nullopt;
}

bool FieldMap::has_value(Cell cell) const {
  return geometry.contains(cell) && std::isfinite(mean_uT[geometry.index(cell)].x());
}

std::optional<FieldPrediction> FieldMap::at(const Eigen::Vector2d& map_point_m) const {
  const Eigen::Vector2d from_center = geometry.to_grid(map_point_m) - Eigen::Vector2d(0.5, 0.5);
  if (!from_center.allFinite() || from_center.cwiseAbs().maxCoeff() > 1e9) return std::nullopt;
  const Cell low{static_cast<int>(std::floor(from_center.x())),
                 static_cast<int>(std::floor(from_center.y()))};
  const double u = from_center.x() - low.column;
  const double v = from_center.y() - low.row;
  FieldPrediction sum;
  for (const auto& [cell, weight] : {std::pair{low, (1 - u) * (1 - v)},
                                     {Cell{low.column + 1, low.row}, u * (1 - v)},
                                     {Cell{low.column, low.row + 1}, (1 - u) * v},
                                     {Cell{low.column + 1, low.row + 1}, u * v}}) {
    if (!has_value(cell)) return std::nullopt;
    const std::size_t i = geometry.index(cell);
    sum.mean_uT += weight * mean_uT[i].cast<double>();
    sum.variance_uT2 += weight * variance_uT2[i].cast<double>();
  }
  return sum;
}

}  // namespace mstsl
