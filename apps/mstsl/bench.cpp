#include "session.hpp"

namespace mstsl::app {

void add_bench(CLI::App&, Session&) {}

}  // namespace mstsl::app
