#pragma once

#include <string>
#include <vector>

#include "session.hpp"

namespace mstsl::app {

/// On stderr, a sentence a line; not with --quiet.
void warn(const Session& session, const std::vector<std::string>& sentences);

}  // namespace mstsl::app
