#include "mstsl/magnetic/hyperparameters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mstsl {

std::map<std::string, double> to_named(const FieldHyperparameters& h) {
  std::map<std::string, double> named;
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    named["mean_" + axis + "_uT"] = h.mean_uT(c);
    named["signal_sd_" + axis + "_uT"] = h.signal_sd_uT(c);
    named["length_scale_" + axis + "_m"] = h.length_scale_m(c);
    named["noise_sd_" + axis + "_uT"] = h.noise_sd_uT(c);
  }
  return named;
}

std::optional<FieldHyperparameters> from_named(const std::map<std::string, double>& named) {
  FieldHyperparameters h;
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    for (const auto& [name, value] : {std::pair{"mean_" + axis + "_uT", &h.mean_uT(c)},
                                      {"signal_sd_" + axis + "_uT", &h.signal_sd_uT(c)},
                                      {"length_scale_" + axis + "_m", &h.length_scale_m(c)},
                                      {"noise_sd_" + axis + "_uT", &h.noise_sd_uT(c)}}) {
      const auto found = named.find(name);
      if (found == named.end()) return std::nullopt;
      *value = found->second;
    }
  }
  return is_valid(h) ? std::optional(h) : std::nullopt;
}

bool is_valid(const FieldHyperparameters& h) {
  const bool finite = h.mean_uT.allFinite() && h.signal_sd_uT.allFinite() && h.length_scale_m.allFinite() &&
                      h.noise_sd_uT.allFinite();
  return finite && (h.signal_sd_uT > 0).all() && (h.length_scale_m > 0).all() && (h.noise_sd_uT > 0).all();
}

std::vector<std::vector<int>> components_by_covariance(const FieldHyperparameters& h) {
  constexpr double kSame = 1e-9;
  const Eigen::Array3d ratio = h.noise_sd_uT / h.signal_sd_uT;
  const auto same = [&](int a, int b) {
    return std::abs(ratio(a) / ratio(b) - 1.0) < kSame &&
           std::abs(h.length_scale_m(a) / h.length_scale_m(b) - 1.0) < kSame;
  };
  std::vector<std::vector<int>> groups;
  for (int c = 0; c < 3; ++c) {
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return same(g.front(), c); });
    if (group == groups.end())
      groups.push_back({c});
    else
      group->push_back(c);
  }
  return groups;
}

}  // namespace mstsl
