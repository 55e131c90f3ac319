#pragma once

namespace mstsl::app {

/// From here on ^C and SIGTERM ask for an orderly end instead of killing the program; a second one kills it.
void stop_on_interrupt();

/// Whether an end was asked for. Long work looks here now and then and closes what it has open.
bool interrupted();

}  // namespace mstsl::app
