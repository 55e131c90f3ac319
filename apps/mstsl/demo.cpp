#include "session.hpp"

namespace mstsl::app {

void add_demo(CLI::App&, Session&) {}

}  // namespace mstsl::app
