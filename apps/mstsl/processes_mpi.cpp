// Where the program is built with MPI (MSTSL_WITH_MPI).
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <mpi.h>

#include "processes.hpp"

namespace mstsl::app {
namespace {

/// A message of MPI counts its bytes in an int.
constexpr std::size_t kMost_bytes = std::size_t{1} << 30;

/// What the process of this rank has to say, told to all.
std::string told_by(int rank, const std::string& mine, bool by_me) {
  std::uint64_t size = by_me ? mine.size() : 0;
  MPI_Bcast(&size, 1, MPI_UINT64_T, rank, MPI_COMM_WORLD);
  std::string text = by_me ? mine : std::string(size, '\0');
  for (std::size_t at = 0; at < size; at += kMost_bytes)
    MPI_Bcast(text.data() + at, static_cast<int>(std::min(kMost_bytes, size - at)), MPI_CHAR, rank,
              MPI_COMM_WORLD);
  return text;
}

}  // namespace

struct Processes::Connection {
  Connection() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  }
  ~Connection() { MPI_Finalize(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
};

Result<Processes> Processes::join() {
  Processes processes;
  if (launched_processes() == 1) return processes;  // without a launcher MPI only costs time
  processes.connection_ = std::make_shared<Connection>();
  Crew& crew = processes.crew_;
  MPI_Comm_rank(MPI_COMM_WORLD, &crew.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &crew.size);
  crew.all_gather = [rank = crew.rank, size = crew.size](const std::string& mine) {
    std::vector<std::string> all;
    for (int other = 0; other < size; ++other) all.push_back(told_by(other, mine, other == rank));
    return all;
  };
  return processes;
}

}  // namespace mstsl::app
