#include "mstsl/localize/methods.hpp"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mstsl {
namespace {

using Maps = std::shared_ptr<const LocalizationMaps>;

Result<LocalizerFactory> make_two_step(Maps maps, const MethodOptions& options) {
  if (auto error = invalid(options.two_step)) return *error;
  return LocalizerFactory(
      [maps, own = options.two_step](const Rig& rig) { return AnyLocalizer(TwoStep(maps, rig, own)); });
}

Result<LocalizerFactory> make_joint(Maps maps, const MethodOptions& options) {
  if (auto error = invalid(options.joint)) return *error;
  JointOptions own = options.joint;
  own.bank.threads = options.threads;
  return LocalizerFactory([maps = joint::make_maps(std::move(maps)), own](const Rig& rig) {
    return AnyLocalizer(Joint(maps, rig, own));
  });
}

Result<LocalizerFactory> make_global_scan(Maps maps, const MethodOptions& options) {
  return LocalizerFactory(
      [maps, own = options.global_scan](const Rig& rig) { return AnyLocalizer(GlobalScan(maps, rig, own)); });
}

/// What an expert sets where people and moved things hide part of a scan: a lower threshold, and a third
/// match in return.
Result<LocalizerFactory> make_global_scan_best(Maps maps, const MethodOptions& options) {
  MethodOptions best = options;
  best.global_scan.min_score = 0.45;
  best.global_scan.agreeing = 3;
  return make_global_scan(std::move(maps), best);
}

Result<LocalizerFactory> make_mag_filter(Maps maps, const MethodOptions& options) {
  return LocalizerFactory(
      [maps, own = options.mag_filter](const Rig& rig) { return AnyLocalizer(MagFilter(maps, rig, own)); });
}

/// What an expert sets who knows that a bias is left and that near readings are not independent.
Result<LocalizerFactory> make_mag_filter_best(Maps maps, const MethodOptions& options) {
  MethodOptions best = options;
  best.mag_filter.particles = 20'000;
  best.mag_filter.sigma_uT = 3.0;
  best.mag_filter.temper = 0.3;
  best.mag_filter.answer_from = 0.95;
  return make_mag_filter(std::move(maps), best);
}

#ifdef MSTSL_HAS_MRPT
Result<LocalizerFactory> make_mcl(Maps maps, const MethodOptions& options) {
  return LocalizerFactory(
      [maps, own = options.mcl](const Rig& rig) { return AnyLocalizer(Mcl(maps, rig, own)); });
}

/// What an expert sets for a start anywhere: enough particles to have some near the truth (MRPT's authors
/// reckon with 280 per m2), beams believed for what they are, wheels for what they are, and doubt before an
/// answer.
Result<LocalizerFactory> make_mcl_best(Maps maps, const MethodOptions& options) {
  MethodOptions best = options;
  best.mcl.particles_per_m2 = 280.0;
  best.mcl.kld_error = 0.01;
  best.mcl.sigma_hit_m = 0.1;
  best.mcl.hit_share = 0.8, best.mcl.random_share = 0.2;
  best.mcl.alpha = 0.05;
  best.mcl.temper = 0.03;
  best.mcl.answer_after_m = 1.0;
  return make_mcl(std::move(maps), best);
}
#endif

struct Method {
  std::string_view name;
  Result<LocalizerFactory> (*make)(Maps, const MethodOptions&);
};

const std::vector<Method> kMethods{
    Method{"two-step", make_two_step},
    Method{"joint", make_joint},
    Method{"global-scan", make_global_scan},
    Method{"global-scan-best", make_global_scan_best},
    Method{"mag-pf", make_mag_filter},
    Method{"mag-pf-best", make_mag_filter_best},
#ifdef MSTSL_HAS_MRPT
    Method{"mcl", make_mcl},
    Method{"mcl-best", make_mcl_best},
#endif
};

}  // namespace

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Method& method : kMethods) names.emplace_back(method.name);
  return names;
}

Result<LocalizerFactory> make_method(std::string_view name, Maps maps, const MethodOptions& options) {
  for (const Method& method : kMethods)
    if (method.name == name) return method.make(std::move(maps), options);
  return Error(
      fmt::format("there is no method '{}'; choose one of {}", name, fmt::join(method_names(), ", ")));
}

}  // namespace mstsl
