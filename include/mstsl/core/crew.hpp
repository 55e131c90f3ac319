#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"

namespace mstsl {

/// The processes that share a piece of work: this one alone, or as many as mpirun started. All of them run
/// the same program with the same options, each does its portion, and the leader writes the results.
struct Crew {
  int rank = 0;  ///< of this process, 0 ... size-1
  int size = 1;
  /// Hands `mine` to all and returns what each handed over, by rank. All must call it equally often: each
  /// waits for the others. Not called where there is one process only.
  std::function<std::vector<std::string>(const std::string& mine)> all_gather;

  bool leads() const { return rank == 0; }
};

/// What each process has, by rank; the first error if any has one, so that all of them end together instead
/// of waiting for one that is gone.
Result<std::vector<std::string>> pooled(const Crew& crew, const Result<std::string>& mine);

/// [first, last) of a list of pieces of work.
struct Portion {
  std::size_t first = 0, last = 0;
};
/// The part of `count` pieces that is this process's: neighbours stay together, no two portions differ by
/// more than one piece.
Portion portion_of(std::size_t count, const Crew& crew);

}  // namespace mstsl
