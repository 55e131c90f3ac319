#pragma once

#include <barrier>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "mstsl/core/crew.hpp"

namespace mstsl::test {

/// Runs `work` once for each of `size` processes, which are threads here.
inline void as_crew(int size, const std::function<void(const Crew&)>& work) {
  std::vector<std::string> given(static_cast<std::size_t>(size));
  std::barrier all(size);
  std::vector<std::jthread> processes;
  for (int rank = 0; rank < size; ++rank)
    processes.emplace_back([&, rank] {
      const auto all_gather = [&](const std::string& mine) {
        given[static_cast<std::size_t>(rank)] = mine;
        all.arrive_and_wait();
        std::vector<std::string> copy = given;
        all.arrive_and_wait();
        return copy;
      };
      work({rank, size, all_gather});
    });
}

}  // namespace mstsl::test
