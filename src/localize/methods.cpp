#include "mstsl/localize/methods.hpp"

#include <array>
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

struct Method {
  std::string_view name;
  Result<LocalizerFactory> (*make)(Maps, const MethodOptions&);
};

constexpr std::array kMethods{Method{"two-step", make_two_step}, Method{"joint", make_joint},
                              Method{"global-scan", make_global_scan}};

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
