#pragma once

#include <string>

namespace mstsl::app {

/// A hash of this very program: runs of another program are not this one's.
std::string build_hash();

}  // namespace mstsl::app
