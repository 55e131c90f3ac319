#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "mstsl/core/angles.hpp"
#include "mstsl/core/random.hpp"
#include "mstsl/magnetic/fingerprint.hpp"

/// Surveys over a field that is a draw from a Gaussian process with a squared exponential covariance, made of
/// random waves and not of anything that the regression knows.
namespace mstsl::test {

class WavyField {
 public:
  WavyField(double length_scale_m, double sd_uT, Random& random) {
    constexpr int kWaves = 150;
    for (auto& component : waves_)
      for (int i = 0; i < kWaves; ++i)
        component.push_back({random.normal() / length_scale_m, random.normal() / length_scale_m,
                             random.uniform(0, 2 * kPi), sd_uT * std::sqrt(2.0 / kWaves) * random.normal()});
  }

  Eigen::Vector3d at(const Eigen::Vector2d& p) const {
    Eigen::Vector3d field(18.0, 3.0, -42.0);
    for (int c = 0; c < 3; ++c)
      for (const Wave& w : waves_[static_cast<std::size_t>(c)])
        field(c) += w.amplitude_uT * std::cos(w.kx * p.x() + w.ky * p.y() + w.phase);
    return field;
  }

 private:
  struct Wave {
    double kx, ky, phase, amplitude_uT;
  };
  std::array<std::vector<Wave>, 3> waves_;
};

struct SurveyPlan {
  double width_m = 6.0, height_m = 4.0;
  double lane_m = 0.5;  ///< between lanes; each is driven both ways
  double step_m = 0.05;
  double noise_uT = 0.2;
  double wander_m = 0.02;  ///< how far a pass lies beside its lane
};

inline std::vector<Fingerprint> drive(const WavyField& field, const SurveyPlan& plan, Random& random) {
  std::vector<Fingerprint> survey;
  const auto read = [&](double x, double y, double heading_rad) {
    Fingerprint f{{x, y}, field.at({x, y}), heading_rad, 0};
    for (int c = 0; c < 3; ++c) f.field_uT(c) += random.normal(0, plan.noise_uT);
    survey.push_back(f);
  };
  for (double y = 0.0; y <= plan.height_m; y += plan.lane_m) {
    const double there = y + random.normal(0, plan.wander_m), back = y + random.normal(0, plan.wander_m);
    for (double x = 0.0; x <= plan.width_m; x += plan.step_m) read(x, there, 0.0);
    for (double x = plan.width_m; x >= 0.0; x -= plan.step_m) read(x, back, kPi);
  }
  return survey;
}

}  // namespace mstsl::test
