#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "session.hpp"

namespace CLI {
class App;
}

namespace mstsl::app {

/// What a user may ask of `bench --protocol real`; the methods are those of the hard protocol's option.
struct RealWish {
  std::filesystem::path data;
  std::optional<int> runs;  ///< of each data set; its own number otherwise
};

void add_real_options(CLI::App& command, RealWish& wish);

/// Every data set that is there, by every method. Data sets that are not there are skipped with a sentence;
/// those that are finished already are taken as they are.
Result<Exit> bench_real(const Session& session, const RealWish& wish, const std::vector<std::string>& methods,
                        const std::filesystem::path& folder);

}  // namespace mstsl::app
