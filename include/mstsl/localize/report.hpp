#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace mstsl {

/// What a localizer met on its way, for people to read beside its estimates.
struct LocalizerReport {
  std::map<std::string, std::uint64_t> counts;  ///< "scans without enough returns" -> 3
  std::vector<std::string> warnings;            ///< one clear sentence each, ready for stderr
};

}  // namespace mstsl
