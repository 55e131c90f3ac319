#include "mstsl/io/calibration_file.hpp"

#include <iterator>
#include <string>

#include <Eigen/SVD>
#include <fmt/format.h>

#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "yaml_values.hpp"

namespace mstsl::io {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kMaxCalibrationBytes = 1 << 20;

YAML::Node three(const YAML::Node& node, const char* key, const char* what) {
  if (!node)
    throw FileProblem(
        "the key '{}' is missing; a calibration has hard_iron_uT and soft_iron, as `mstsl calibrate` "
        "writes them",
        key);
  if (!node.IsSequence() || node.size() != 3)
    throw FileProblem("'{}' (line {}) is not a list of three {}", key, node.Mark().line + 1, what);
  return node;
}

Vector3d vector_from(const YAML::Node& node, const char* key) {
  const YAML::Node list = three(node, key, "numbers");
  Vector3d v;
  for (int i = 0; i < 3; ++i) v(i) = yaml_finite_number(list[i], key);
  return v;
}

MagnetometerCalibration calibration_from(const YAML::Node& root) {
  if (!root.IsMap()) throw FileProblem("this is no calibration: it has no keys");
  MagnetometerCalibration calibration;
  calibration.hard_iron_uT = vector_from(root["hard_iron_uT"], "hard_iron_uT");
  const YAML::Node rows = three(root["soft_iron"], "soft_iron", "rows of three numbers");
  for (int r = 0; r < 3; ++r) calibration.soft_iron.row(r) = vector_from(rows[r], "soft_iron").transpose();
  constexpr double kLeast = 1.0 / 3.0, kMost = 3.0;
  const Vector3d scales = Eigen::JacobiSVD<Matrix3d>(calibration.soft_iron).singularValues();
  if (calibration.soft_iron.determinant() <= 0.0 || scales(2) < kLeast || scales(0) > kMost)
    throw FileProblem("'soft_iron' is no distortion that a robot makes: it scales by {:.3g} to {:.3g}{}",
                      scales(2), scales(0), calibration.soft_iron.determinant() <= 0.0 ? " and mirrors" : "");
  return calibration;
}

std::string list(const Vector3d& v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x(), v.y(), v.z()); }

}  // namespace

Result<MagnetometerCalibration> read_calibration(const std::filesystem::path& yaml) {
  const Result<std::string> text = read_file(yaml, kMaxCalibrationBytes);
  if (!text) return text.error();
  return guarded(yaml, [&] { return parse_yaml(*text, calibration_from); });
}

Result<void> write_calibration(const TurnCalibration& found, const std::filesystem::path& yaml) {
  const MagnetometerCalibration& c = found.calibration;
  std::string text =
      "# Magnetometer calibration: corrected = soft_iron * (reading - hard_iron_uT), in the sensor's own "
      "axes.\n";
  text += fmt::format("hard_iron_uT: {}\nsoft_iron:\n", list(c.hard_iron_uT));
  for (int r = 0; r < 3; ++r) text += fmt::format("  - {}\n", list(c.soft_iron.row(r).transpose()));
  text += fmt::format(
      "# How it was found: {} turns on the spot, {} readings; the horizontal strength changed by {:.3g} uT "
      "rms over a\n"
      "# turn before, {:.3g} uT after. Turning in the plane shows neither the hard iron along the axis of "
      "rotation, nor\n"
      "# the field's true strength, nor what the vertical field induces, nor a twist about the axis.\n"
      "hard_iron_sd_uT: {}\nsoft_iron_sd: {:.3g}\n",
      found.turns, found.readings, found.uncorrected_uT, found.corrected_uT, list(found.hard_iron_sd_uT),
      found.soft_iron_sd);
  return write_file(yaml, text);
}

}  // namespace mstsl::io
