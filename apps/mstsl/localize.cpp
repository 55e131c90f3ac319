#include "session.hpp"

namespace mstsl::app {

void add_localize(CLI::App&, Session&) {}

}  // namespace mstsl::app
