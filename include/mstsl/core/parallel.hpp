#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace mstsl {

/// How many threads a piece of work may use; 0 means all cores. Results never depend on it.
struct Threads {
  int count = 0;
};

/// Calls `work(i)` once for each i in 0 .. count-1, in any order, on up to `threads` threads, and waits for
/// all. To stay reproducible each call writes only what belongs to its own i, and sums are taken afterwards
/// in index order.
void parallel_for(std::size_t count, Threads threads, const std::function<void(std::size_t)>& work);

/// Memory that the calls of a `parallel_for` lend each other: each takes one, made where none is left, and
/// gives it back.
template <typename T>
class Spares {
 public:
  T take() {
    const std::lock_guard lock(mutex_);
    if (spares_.empty()) return T();
    T spare = std::move(spares_.back());
    spares_.pop_back();
    return spare;
  }
  void give(T spare) {
    const std::lock_guard lock(mutex_);
    spares_.push_back(std::move(spare));
  }

 private:
  std::mutex mutex_;
  std::vector<T> spares_;
};

}  // namespace mstsl
