#include "warnings.hpp"

#include <fmt/format.h>

namespace mstsl::app {

void warn(const Session& session, const std::vector<std::string>& sentences) {
  if (session.quiet) return;
  for (const std::string& sentence : sentences) fmt::print(stderr, "mstsl: warning: {}\n", sentence);
}

}  // namespace mstsl::app
