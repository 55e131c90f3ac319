// A part of a survey as in the paper's car park (39 fingerprints a square metre on lanes 1 m apart, length
// scale 0.45 m): made for another program to krige, then solved by ours and compared with the dense solution.
// See gstat.sh.
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/os.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/magnetic/field_map_builder.hpp"
#include "mstsl/magnetic/gaussian_process.hpp"

namespace mstsl {
namespace {

namespace fs = std::filesystem;

constexpr double kSide_m = 20.0, kLane_m = 1.0, kStep_m = 0.051;
constexpr double kSignal_uT = 7.0, kLengthScale_m = 0.45, kNoise_uT = 0.55, kCell_m = 0.05;

/// Random waves whose spectrum is that of the squared exponential.
struct Waves {
  explicit Waves(Random& random) {
    for (int i = 0; i < 300; ++i)
      waves.push_back({{random.normal() / kLengthScale_m, random.normal() / kLengthScale_m},
                       random.uniform(0, 2 * kPi),
                       kSignal_uT * std::sqrt(2.0 / 300.0) * random.normal()});
  }
  double at(const Eigen::Vector2d& p) const {
    double sum = 0.0;
    for (const Wave& w : waves) sum += w.amplitude * std::cos(w.k.dot(p) + w.phase);
    return sum;
  }
  struct Wave {
    Eigen::Vector2d k;
    double phase, amplitude;
  };
  std::vector<Wave> waves;
};

std::vector<Fingerprint> survey() {
  Random random(1);
  const std::vector<Waves> components = {Waves(random), Waves(random), Waves(random)};
  std::vector<Fingerprint> fingerprints;
  for (double lane = 0.0; lane <= kSide_m; lane += kLane_m)
    for (const double heading_rad : {0.0, kPi}) {
      const double y = lane + random.normal(0, 0.03);
      for (double x = 0.0; x <= kSide_m; x += kStep_m) {
        Fingerprint f{{x, y}, Eigen::Vector3d::Zero(), heading_rad, 0};
        for (int c = 0; c < 3; ++c)
          f.field_uT(c) = components[c].at(f.position_m) + random.normal(0, kNoise_uT);
        fingerprints.push_back(f);
      }
    }
  return fingerprints;
}

/// Centres of the cells, as the map has them.
std::vector<Eigen::Vector2d> cells() {
  std::vector<Eigen::Vector2d> centers;
  for (double y = 0.5 * kCell_m; y < kSide_m; y += kCell_m)
    for (double x = 0.5 * kCell_m; x < kSide_m; x += kCell_m) centers.emplace_back(x, y);
  return centers;
}

void make(const fs::path& folder) {
  auto model = fmt::output_file((folder / "model.csv").string());
  model.print("signal_sd,noise_sd,length_scale_m\n{},{},{}\n", kSignal_uT, kNoise_uT, kLengthScale_m);
  auto samples = fmt::output_file((folder / "samples.csv").string());
  samples.print("x,y,bx,by,bz\n");
  for (const Fingerprint& f : survey())
    samples.print("{},{},{},{},{}\n", f.position_m.x(), f.position_m.y(), f.field_uT.x(), f.field_uT.y(),
                  f.field_uT.z());
  auto places = fmt::output_file((folder / "cells.csv").string());
  places.print("x,y\n");
  for (const Eigen::Vector2d& p : cells()) places.print("{},{}\n", p.x(), p.y());
}

/// Means and variance at cells, in uT.
struct Solution {
  std::vector<Eigen::Vector3d> mean;
  std::vector<double> variance;
  double cpu_s = 0.0;
};

double cpu_now_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Solution ours(RegressionQuality quality) {
  FieldMapOptions options;
  options.quality = quality;
  options.resolution_m = kCell_m;
  options.reach_m = 0.1;
  options.threads = Threads{1};
  options.analysis.bias_removal = BiasRemoval::kNever;
  options.analysis.calibrate_variance = false;
  options.analysis.hyperparameters =
      FieldHyperparameters{Eigen::Array3d::Zero(), Eigen::Array3d::Constant(kSignal_uT),
                           Eigen::Array3d::Constant(kLengthScale_m), Eigen::Array3d::Constant(kNoise_uT)};
  const auto analysis = analyse_survey(survey(), FieldModel::kGpr, options.analysis);
  // Every cell of the square, not only those near a lane.
  GridGeometry geometry;
  geometry.resolution_m = kCell_m;
  geometry.columns = geometry.rows = static_cast<int>(std::lround(kSide_m / kCell_m));
  const OccupancyGrid square(geometry, CellState::kFree);
  const double before_s = cpu_now_s();
  const auto map = build_field_map(analysis.value(), &square, options);
  Solution solution;
  solution.cpu_s = cpu_now_s() - before_s;
  for (const Eigen::Vector2d& p : cells()) {
    const auto at = map->at(p);
    solution.mean.push_back(at->mean_uT);
    solution.variance.push_back(at->variance_uT2.x() - kNoise_uT * kNoise_uT);
  }
  return solution;
}

Solution of_gstat(const fs::path& folder) {
  Solution solution;
  std::ifstream(folder / "gstat_cpu_s.txt") >> solution.cpu_s;
  std::ifstream file(folder / "gstat.csv");
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    double v[8] = {};
    std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5, v + 6,
                v + 7);
    solution.mean.emplace_back(v[2], v[4], v[6]);
    solution.variance.push_back(v[3]);
  }
  return solution;
}

/// The dense solution at some cells in the middle, from everything within seven length scales of it.
struct Oracle {
  std::vector<std::size_t> cells;
  std::vector<Eigen::Vector3d> mean;
  std::vector<double> variance;
};
Oracle oracle() {
  static constexpr double kMiddle_m = 0.5 * kSide_m, kHalf_m = 1.5, kAround_m = kHalf_m + 7 * kLengthScale_m;
  constexpr std::size_t kStride = 7;
  const auto within = [](const Eigen::Vector2d& p, double half_m) {
    return (p.array() - kMiddle_m).abs().maxCoeff() <= half_m;
  };
  std::vector<Eigen::Vector2d> points, some;
  std::vector<Eigen::Vector3d> fields;
  for (const Fingerprint& f : survey())
    if (within(f.position_m, kAround_m)) {
      points.push_back(f.position_m);
      fields.push_back(f.field_uT);
    }
  Eigen::MatrixXd values(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < fields.size(); ++i)
    values.row(static_cast<Eigen::Index>(i)) = fields[i].transpose();
  Oracle oracle;
  const auto all = cells();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (within(all[i], kHalf_m) && i % kStride == 0) {
      oracle.cells.push_back(i);
      some.push_back(all[i]);
    }
  const auto kernel = SquaredExponential{kSignal_uT, kLengthScale_m} + WhiteNoise{kNoise_uT};
  const auto prediction = fit_exactly(kernel, points, values, false)->predict(some);
  for (Eigen::Index i = 0; i < prediction.mean.rows(); ++i) {
    oracle.mean.emplace_back(prediction.mean.row(i));
    oracle.variance.push_back(prediction.variance(i));
  }
  return oracle;
}

void compare(const fs::path& folder) {
  const Oracle exact = oracle();
  const Solution gstat = of_gstat(folder);
  fmt::print("{} fingerprints, {} cells, three components\n{:<24}{:>10}{:>22}{:>24}{:>14}\n", survey().size(),
             cells().size(), "", "CPU s", "mean, rms error uT", "variance, worst error", "CPU, gstat is");
  const auto tell = [&](const char* name, const Solution& s) {
    double squared = 0.0, worst = 0.0;
    for (std::size_t k = 0; k < exact.mean.size(); ++k) {
      squared += (s.mean[exact.cells[k]] - exact.mean[k]).squaredNorm() / 3.0;
      const double reading = exact.variance[k] + kNoise_uT * kNoise_uT;
      worst = std::max(worst, std::abs(s.variance[exact.cells[k]] - exact.variance[k]) / reading);
    }
    fmt::print("{:<24}{:>10.3f}{:>12.4f} ({:>4.1f} % noise){:>22.1f} %{:>12.0f} x\n", name, s.cpu_s,
               std::sqrt(squared / static_cast<double>(exact.mean.size())),
               100 * std::sqrt(squared / static_cast<double>(exact.mean.size())) / kNoise_uT, 100 * worst,
               gstat.cpu_s / s.cpu_s);
  };
  tell("mstsl, fast", ours(RegressionQuality::kFast));
  tell("mstsl, exact", ours(RegressionQuality::kExact));
  tell("gstat, 50 neighbours", gstat);
}

}  // namespace
}  // namespace mstsl

int main(int count, char** arguments) {
  const std::string what = count == 3 ? arguments[1] : "";
  if (what == "make") return mstsl::make(arguments[2]), 0;
  if (what == "compare") return mstsl::compare(arguments[2]), 0;
  fmt::print(stderr, "usage: field_map_part make|compare FOLDER\n");
  return 2;
}
