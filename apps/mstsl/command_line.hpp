#pragma once

#include <string>
#include <vector>

namespace mstsl::app {

/// Does what `mstsl ARGUMENTS` on a command line does, messages included, and gives its exit status. Commands
/// that are made of others (demo) call it, too, so that what they do can be typed by hand.
int run_command_line(const std::vector<std::string>& arguments);

/// Prints one line on stderr and gives the status for it.
int fail(const std::string& sentence);

}  // namespace mstsl::app
