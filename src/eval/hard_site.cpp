#include "hard_site.hpp"

#include <utility>

#include <fmt/format.h>

namespace mstsl {
namespace {

/// A random stream that belongs to a name (FNV-1a), so that a case is the same whatever other cases are run.
std::uint64_t stream_of(std::string_view name) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

Result<std::vector<LocalizerFactory>> factories_for(const std::vector<std::string>& names,
                                                    const HardBuilding& building, MethodOptions options) {
  options.threads = {1};  // the runs share out the cores; a method's CPU time is its thread's
  std::vector<LocalizerFactory> factories;
  for (const std::string& name : names) {
    auto factory = make_method(name, building.maps, options);
    if (!factory) return factory.error();
    factories.push_back(std::move(factory).value());
  }
  return factories;
}

}  // namespace

Result<HardSite> make_site(const HardProtocolOptions& options, const std::string& world, int building,
                           const SurveyKind& kind) {
  const Random random = Random(options.seed).fork(stream_of(world));
  std::string name = fmt::format("map_{}_{}_{}_seed{}", world, building, kind.name(), options.seed);
  if (!options.build.empty()) name += "_" + options.build;  // another program's map may be another
  Result<HardBuilding> made = make_building(
      world, kind, random.fork(stream_of("building")).fork(static_cast<std::uint64_t>(building)),
      options.folder, name, options.threads);
  if (!made) return made.error();
  auto methods = factories_for(options.methods, *made, options.method_options);
  if (!methods) return methods.error();
  return HardSite{std::move(made).value(), std::move(methods).value(),
                  random.fork(stream_of(to_string(options.set))), options.folder / (name + ".nc")};
}

std::string text_of(const HardProtocolOptions& options) {
  return fmt::format("seed {} length_m {} buildings {} scan_rate_hz {} beams {}", options.seed,
                     options.length_m, options.buildings, options.scan_rate_hz, options.beams);
}

HardKey key_of(const HardProtocolOptions& options, std::string_view world, std::string_view disturbance,
               std::string_view method, int run) {
  return {std::string(to_string(options.set)), std::string(world), std::string(disturbance),
          std::string(method), run};
}

}  // namespace mstsl
