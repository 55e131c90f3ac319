#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "mstsl/core/random.hpp"
#include "mstsl/core/result.hpp"

namespace mstsl::datasets {

/// A stretch of a recording: its rows first .. last, both included.
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
  friend bool operator==(const Window&, const Window&) = default;
};

/// Metres from row 0 to each row.
std::vector<double> distances_along(std::span<const Eigen::Vector2d> path_m);

/// Every stretch that begins at a row and is `length_m` long (its last row is the first one that far on),
/// inside which each row may follow the one before: `follows[i]` says whether row i continues row i - 1
/// (`follows[0]` is not read). Expects one entry in `follows` for each row.
std::vector<Window> windows_of_length(std::span<const Eigen::Vector2d> path_m,
                                      const std::vector<bool>& follows, double length_m);

/// `count` different windows of those given, each as likely as the other, in the order drawn. Errors: there
/// are fewer.
Result<std::vector<Window>> draw_windows(std::vector<Window> windows, std::size_t count, Random random);

}  // namespace mstsl::datasets
