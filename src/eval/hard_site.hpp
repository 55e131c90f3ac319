#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mstsl/eval/hard_protocol.hpp"

#include "hard_building.hpp"

namespace mstsl {

/// A building of the protocol with everything that its runs need.
struct HardSite {
  HardBuilding building;
  std::vector<LocalizerFactory> methods;  ///< one for each of the options' methods
  Random runs;                            ///< forked by a run's number it decides all of that run
  std::filesystem::path field;            ///< the field map's file
};

/// The same site for the same options, whatever else is run. Errors: those of make_building() and
/// make_method().
Result<HardSite> make_site(const HardProtocolOptions& options, const std::string& world, int building,
                           const SurveyKind& kind);

/// What else decides a run, in words: seed, length, lidar.
std::string text_of(const HardProtocolOptions& options);

HardKey key_of(const HardProtocolOptions& options, std::string_view world, std::string_view disturbance,
               std::string_view method, int run);

}  // namespace mstsl
