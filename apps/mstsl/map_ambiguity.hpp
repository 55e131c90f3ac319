#pragma once

#include <filesystem>
#include <optional>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/ambiguity.hpp"

#include "session.hpp"

namespace mstsl::app {

/// What the user of `mstsl map ambiguity` gave.
struct AmbiguityWish {
  std::filesystem::path map;
  std::filesystem::path field;
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> picture;
  AmbiguityOptions options;
};

/// Says and draws where on the maps a robot will find itself.
Result<Exit> map_ambiguity(const Session& session, const AmbiguityWish& wish);

}  // namespace mstsl::app
