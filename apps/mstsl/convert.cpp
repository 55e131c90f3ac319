#include "session.hpp"

namespace mstsl::app {

void add_convert(CLI::App&, Session&) {}

}  // namespace mstsl::app
