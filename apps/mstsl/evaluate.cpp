#include "session.hpp"

namespace mstsl::app {

void add_evaluate(CLI::App&, Session&) {}

}  // namespace mstsl::app
