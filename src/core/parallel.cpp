#include "mstsl/core/parallel.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace mstsl {

void parallel_for(std::size_t count, Threads threads, const std::function<void(std::size_t)>& work) {
  if (threads.count == 1 || count < 2) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  tbb::task_arena arena(threads.count > 0 ? threads.count : tbb::task_arena::automatic);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, work, tbb::simple_partitioner{}); });
}

}  // namespace mstsl
