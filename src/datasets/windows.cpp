#include "mstsl/datasets/windows.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

namespace mstsl::datasets {

std::vector<double> distances_along(std::span<const Eigen::Vector2d> path_m) {
  std::vector<double> distances_m(path_m.size(), 0.0);
  for (std::size_t i = 1; i < path_m.size(); ++i)
    distances_m[i] = distances_m[i - 1] + (path_m[i] - path_m[i - 1]).norm();
  return distances_m;
}

std::vector<Window> windows_of_length(std::span<const Eigen::Vector2d> path_m,
                                      const std::vector<bool>& follows, double length_m) {
  assert(follows.size() == path_m.size());
  const std::vector<double> along_m = distances_along(path_m);
  std::vector<Window> windows;
  std::size_t broken = 0;  // the first row at or after `last` + 1 that begins anew
  for (std::size_t first = 0, last = 0; first < path_m.size(); ++first) {
    last = std::max(last, first);
    while (last < path_m.size() && along_m[last] - along_m[first] < length_m) ++last;
    if (last == path_m.size()) break;
    broken = std::max(broken, first + 1);
    while (broken <= last && follows[broken]) ++broken;
    if (broken > last) windows.push_back({first, last});
  }
  return windows;
}

Result<std::vector<Window>> draw_windows(std::vector<Window> windows, std::size_t count, Random random) {
  if (windows.size() < count)
    return Error(fmt::format(
        "only {} stretches are long enough to be a run, fewer than the {} asked for; ask for fewer "
        "or shorter runs",
        windows.size(), count));
  for (std::size_t i = 0; i < count; ++i)
    std::swap(windows[i], windows[i + random.index(windows.size() - i)]);
  windows.resize(count);
  return windows;
}

}  // namespace mstsl::datasets
