#include "progress.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace mstsl::app {

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

void Progress::show(double share) {
  using namespace std::chrono_literals;
  const auto now = Clock::now();
  if (!visible_ || now - start_ < 1s || now - last_ < 100ms) return;
  last_ = now;
  drawn_ = true;
  constexpr int kWidth = 30;
  const double done = std::clamp(share, 0.0, 1.0);
  const int filled = static_cast<int>(done * kWidth);
  const double left_s =
      std::chrono::duration<double>(now - start_).count() * (1.0 - done) / std::max(done, 1e-3);
  fmt::print(stderr, "\r\033[K{} [{:=<{}}{: <{}}] {:3.0f} %, {:.0f} s left", what_, "", filled, "",
             kWidth - filled, 100 * done, left_s);
  std::fflush(stderr);
}

}  // namespace mstsl::app
