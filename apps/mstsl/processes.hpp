#pragma once

#include <memory>

#include "mstsl/core/crew.hpp"
#include "mstsl/core/result.hpp"

namespace mstsl::app {

/// This process among those that mpirun started, while it lives; alone without mpirun.
class Processes {
 public:
  /// To be called by all of them, once. Errors: there are several, but this program was built without MPI:
  /// each would do all of the work and write over the others' files.
  static Result<Processes> join();

  const Crew& crew() const { return crew_; }

 private:
  struct Connection;  // ends with the last copy
  std::shared_ptr<Connection> connection_;
  Crew crew_;
};

/// How many processes a launcher says that it started (Open MPI, MPICH, Slurm's srun --mpi); 1 if none did.
int launched_processes();

}  // namespace mstsl::app
