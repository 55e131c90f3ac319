#pragma once

#include <functional>
#include <string>

#include "mstsl/core/random.hpp"

namespace mstsl::test {

/// Calls `parse` with up to `count` prefixes and `count` damaged copies of a good file: single bits,
/// overwritten runs, cut-out and repeated pieces. `parse` must answer, with a value or an error, and not
/// crash.
inline void for_each_damage(const std::string& good, int count, Random random,
                            const std::function<void(const std::string&)>& parse) {
  const std::size_t step = good.size() / static_cast<std::size_t>(count) + 1;
  for (std::size_t length = 0; length < good.size(); length += step) parse(good.substr(0, length));
  for (int i = 0; i < count; ++i) {
    std::string bad = good;
    for (std::size_t hits = 1 + random.index(4); hits > 0; --hits) {
      const std::size_t at = random.index(bad.size());
      const std::size_t run = 1 + random.index(8);
      switch (random.index(4)) {
        case 0:
          bad[at] = static_cast<char>(bad[at] ^ (1 << random.index(8)));
          break;
        case 1:
          bad.replace(at, run, run, static_cast<char>(random.chance(0.5) ? 0xff : random.index(256)));
          break;
        case 2:
          bad.erase(at, bad.size() > run + 1 ? run : 0);
          break;
        default:
          bad.insert(at, bad.substr(at, run));
          break;
      }
    }
    parse(bad);
  }
}

}  // namespace mstsl::test
