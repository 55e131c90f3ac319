#include "session.hpp"

namespace mstsl::app {

void add_info(CLI::App&, Session&) {}

}  // namespace mstsl::app
