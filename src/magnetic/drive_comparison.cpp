#include "drive_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "mstsl/magnetic/survey_bias.hpp"

namespace mstsl {
namespace {

using Eigen::Array3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One fingerprint against the map, where the map knows the place.
struct Compared {
  std::size_t index;  ///< of the fingerprint
  Vector3d error_uT;  ///< measured minus foretold, map frame
  Vector3d foretold_uT;
  Array3d variance_uT2;  ///< of the error: the map's, and what the place's is worth there
  Matrix3d map_R_base;

  double mean_square(const Vector3d& base_bias_uT) const {
    return ((error_uT - map_R_base * base_bias_uT).array().square() / variance_uT2).mean();
  }
};

/// Square of how steep each component is, in uT2/m2; 0 at the map's edge.
Array3d squared_slope(const FieldMap& map, const Eigen::Vector2d& at_m) {
  const double step_m = map.geometry.resolution_m;
  Array3d sum = Array3d::Zero();
  for (const Eigen::Vector2d& axis : {Eigen::Vector2d(step_m, 0.0), Eigen::Vector2d(0.0, step_m)}) {
    const auto before = map.at(at_m - axis), after = map.at(at_m + axis);
    if (before && after) sum += ((after->mean_uT - before->mean_uT) / (2.0 * step_m)).array().square();
  }
  return sum;
}

std::vector<Compared> compare(const FieldMap& map, std::span<const Fingerprint> drive, double place_sd_m) {
  std::vector<Compared> compared;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const Fingerprint& f = drive[i];
    const Cell cell = map.geometry.cell_at(f.position_m);
    const auto foretold = map.at(f.position_m);
    if (!foretold || !map.geometry.contains(cell) || map.supported[map.geometry.index(cell)] == 0) continue;
    const Array3d by_place = place_sd_m * place_sd_m * squared_slope(map, f.position_m);
    compared.push_back({i, f.field_uT - foretold->mean_uT, foretold->mean_uT,
                        foretold->variance_uT2.array() + by_place, f.map_R_base()});
  }
  return compared;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The constant error of the drive's magnetometer in the base's frame: begun at the median, then least
/// squares under Cauchy's weights, which give little to what has changed.
Vector3d robust_bias(const std::vector<Compared>& compared) {
  constexpr int kIterations = 30;
  constexpr double kWidth = 2.0;        // sigmas; Cauchy's usual 2.385 is for one component
  constexpr double kPriorSd_uT = 20.0;  // as in survey_bias.hpp
  Vector3d bias;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> errors;
    for (const Compared& e : compared) errors.push_back((e.map_R_base.transpose() * e.error_uT)(c));
    bias(c) = median(std::move(errors));
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix3d information = Matrix3d::Identity() / (kPriorSd_uT * kPriorSd_uT);
    Vector3d sum = Vector3d::Zero();
    for (const Compared& e : compared) {
      const double weight = 1.0 / (1.0 + e.mean_square(bias) / (kWidth * kWidth));
      const Matrix3d part =
          weight * e.map_R_base.transpose() * e.variance_uT2.inverse().matrix().asDiagonal();
      information += part * e.map_R_base;
      sum += part * e.error_uT;
    }
    bias = information.ldlt().solve(sum);
  }
  return bias;
}

/// Median square of the error by the median square of the foretold field's departure from its mean.
double unexplained_share(const std::vector<Compared>& compared, const Vector3d& bias) {
  Vector3d mean = Vector3d::Zero();
  for (const Compared& e : compared) mean += e.foretold_uT / static_cast<double>(compared.size());
  std::vector<double> errors, departures;
  for (const Compared& e : compared) {
    errors.push_back((e.error_uT - e.map_R_base * bias).squaredNorm());
    departures.push_back((e.foretold_uT - mean).squaredNorm());
  }
  constexpr double kLeast_uT2 = 0.01;  // a field without structure tells nothing
  return median(std::move(errors)) / std::max(kLeast_uT2, median(std::move(departures)));
}

/// Way along the drive to each fingerprint, in m; gaps count for nothing.
std::vector<double> ways(std::span<const Fingerprint> drive) {
  constexpr double kGap_m = 0.5;
  std::vector<double> way_m(drive.size(), 0.0);
  for (std::size_t i = 1; i < drive.size(); ++i) {
    const double step_m = (drive[i].position_m - drive[i - 1].position_m).norm();
    way_m[i] = way_m[i - 1] + (step_m < kGap_m ? step_m : 0.0);
  }
  return way_m;
}

/// Mean square error, in the map's variances, over the stretch around each fingerprint that was compared.
std::vector<double> stretch_errors(const std::vector<Compared>& compared, const std::vector<double>& way_m,
                                   const Vector3d& bias, double stretch_m) {
  std::vector<double> means;
  std::size_t first = 0, last = 0;  // of the stretch: [first, last)
  for (const Compared& e : compared) {
    const double here_m = way_m[e.index];
    while (way_m[compared[first].index] < here_m - stretch_m / 2) ++first;
    while (last < compared.size() && way_m[compared[last].index] <= here_m + stretch_m / 2) ++last;
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) sum += compared[i].mean_square(bias);
    means.push_back(sum / static_cast<double>(last - first));
  }
  return means;
}

/// 1 where an error is over the limit, and beside such places where it is still over a quarter of it (half as
/// many standard deviations): what moved is felt beyond where it is beyond doubt.
std::vector<std::uint8_t> over_limit(const std::vector<double>& errors, double limit) {
  std::vector<std::uint8_t> over(errors.size(), 0);
  const auto spread = [&](std::size_t i, bool& beside) {
    beside = errors[i] > limit || (beside && errors[i] > 0.25 * limit);
    if (beside) over[i] = 1;
  };
  bool beside = false;
  for (std::size_t i = 0; i < errors.size(); ++i) spread(i, beside);
  beside = false;
  for (std::size_t i = errors.size(); i-- > 0;) spread(i, beside);
  return over;
}

FieldChange describe(std::span<const Compared> stretch, std::span<const Fingerprint> drive,
                     const std::vector<double>& way_m, const Vector3d& bias) {
  FieldChange change;
  Array3d squares = Array3d::Zero();
  for (const Compared& e : stretch) squares += (e.error_uT - e.map_R_base * bias).array().square();
  change.rms_uT = (squares / static_cast<double>(stretch.size())).sqrt();
  change.center_m = drive[stretch[stretch.size() / 2].index].position_m;
  change.length_m = way_m[stretch.back().index] - way_m[stretch.front().index];
  return change;
}

/// Adjacent fingerprints that are changed make one change.
std::vector<FieldChange> changes_of(const std::vector<Compared>& compared,
                                    const std::vector<std::uint8_t>& changed,
                                    std::span<const Fingerprint> drive, const std::vector<double>& way_m,
                                    const Vector3d& bias) {
  std::vector<FieldChange> changes;
  for (std::size_t i = 0; i < compared.size();) {
    std::size_t end = i;
    while (end < compared.size() && changed[compared[end].index] != 0) ++end;
    if (end > i) changes.push_back(describe(std::span(compared).subspan(i, end - i), drive, way_m, bias));
    i = std::max(end, i + 1);
  }
  return changes;
}

}  // namespace

ComparedDrive compare_drive(const FieldMap& map, std::span<const Fingerprint> drive,
                            const FieldUpdateOptions& options) {
  // The median of the mean square of three normal numbers of variance 1.
  constexpr double kMedianMeanSquare = 0.789;
  ComparedDrive result{{drive.begin(), drive.end()}, std::vector<std::uint8_t>(drive.size(), 0), {}};
  DriveComparison& comparison = result.comparison;
  const std::vector<double> way_m = ways(drive);
  const std::vector<Compared> compared = compare(map, drive, options.place_sd_m);
  if (!compared.empty()) {
    const Vector3d bias = comparison.base_bias_uT = robust_bias(compared);
    const std::vector<double> errors = stretch_errors(compared, way_m, bias, options.stretch_m);
    const double usual = median(errors) / kMedianMeanSquare;
    comparison.usual_sigmas = std::sqrt(usual);
    comparison.unexplained = unexplained_share(compared, bias);
    const double limit = options.changed_sigmas * options.changed_sigmas * std::max(1.0, usual);
    const std::vector<std::uint8_t> over = over_limit(errors, limit);
    for (std::size_t i = 0; i < compared.size(); ++i) result.changed[compared[i].index] = over[i];
    comparison.changes = changes_of(compared, result.changed, drive, way_m, bias);
    for (Fingerprint& f : result.fingerprints) f.field_uT -= f.map_R_base() * bias;
  }
  const double whole_m = way_m.empty() ? 0.0 : way_m.back();
  const double share =
      drive.empty() ? 0.0 : static_cast<double>(compared.size()) / static_cast<double>(drive.size());
  comparison.compared_m = share * whole_m;
  comparison.new_m = whole_m - comparison.compared_m;
  for (const FieldChange& change : comparison.changes) comparison.changed_m += change.length_m;
  comparison.check = check_field_map(map, result.fingerprints);
  return result;
}

}  // namespace mstsl
