#include "session.hpp"

namespace mstsl::app {

void add_map(CLI::App&, Session&) {}

}  // namespace mstsl::app
