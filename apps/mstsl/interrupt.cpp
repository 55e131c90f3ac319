#include "interrupt.hpp"

#include <atomic>
#include <csignal>
#include <string_view>

#include <unistd.h>

namespace mstsl::app {
namespace {

std::atomic<bool> interrupt_seen = false;  // the one global: a signal handler has no other way to be heard

void on_signal(int) {
  interrupt_seen = true;
  constexpr std::string_view kStopping = "\nmstsl: stopping after this step; ^C again stops at once\n";
  if (isatty(STDERR_FILENO) != 0) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, kStopping.data(), kStopping.size());
  }
}

}  // namespace

void stop_on_interrupt() {
  struct sigaction once {};
  once.sa_handler = on_signal;
  once.sa_flags = SA_RESETHAND;  // and no SA_RESTART: waiting for a pipe that nobody writes to ends, too
  sigaction(SIGINT, &once, nullptr);
  sigaction(SIGTERM, &once, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is then an error of the write that meets it
}

bool interrupted() { return interrupt_seen; }

}  // namespace mstsl::app
