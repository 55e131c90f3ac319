#pragma once

#include <cstddef>
#include <functional>

namespace mstsl {

/// How many threads a piece of work may use; 0 means all cores. Results never depend on it.
struct Threads {
  int count = 0;
};

/// Calls `work(i)` once for each i in 0 .. count-1, in any order, on up to `threads` threads, and waits for
/// all. To stay reproducible each call writes only what belongs to its own i, and sums are taken afterwards
/// in index order.
void parallel_for(std::size_t count, Threads threads, const std::function<void(std::size_t)>& work);

}  // namespace mstsl
