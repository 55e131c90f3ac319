// Where the program is built without MPI.
#include <fmt/format.h>

#include "processes.hpp"

namespace mstsl::app {

struct Processes::Connection {};

Result<Processes> Processes::join() {
  if (const int size = launched_processes(); size > 1)
    return Error(
        fmt::format("{} processes were started, but this program is built without MPI: configure it with "
                    "-DMSTSL_WITH_MPI=ON (Debian: libopenmpi-dev), or start it once and give it --threads",
                    size));
  return Processes();
}

}  // namespace mstsl::app
