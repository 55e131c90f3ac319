#include "session.hpp"

namespace mstsl::app {

void add_simulate(CLI::App&, Session&) {}

}  // namespace mstsl::app
