#include "mstsl/magnetic/hyperparameters.hpp"

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

bool is_valid(const FieldHyperparameters& h) {
  const bool finite = h.mean_uT.allFinite() && h.signal_sd_uT.allFinite() && h.length_scale_m.allFinite() &&
                      h.noise_sd_uT.allFinite();
  return finite && (h.signal_sd_uT > 0).all() && (h.length_scale_m > 0).all() && (h.noise_sd_uT > 0).all();
}

}  // namespace mstsl
