#include "interrupt.hpp"

#include <atomic>
#include <csignal>

namespace mstsl::app {
namespace {

std::atomic<bool> interrupt_seen = false;  // the one global: a signal handler has no other way to be heard

void on_signal(int signal) {
  interrupt_seen = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void stop_on_interrupt() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return interrupt_seen; }

}  // namespace mstsl::app
