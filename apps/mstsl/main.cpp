#include <exception>
#include <new>

#include <fmt/format.h>
#ifdef MSTSL_HAS_GLOG
#include <glog/logging.h>
#endif

#include "command_line.hpp"

int main(int argc, char** argv) {
  using namespace mstsl::app;
#ifdef MSTSL_HAS_GLOG
  FLAGS_minloglevel = google::GLOG_ERROR;  // a solver's remarks to its authors are nothing to our users
#endif
  try {
    return run_command_line({argv + 1, argv + argc});
  } catch (const std::bad_alloc&) {
    return fail("out of memory; give it a smaller map or log, or a larger machine");
  } catch (const std::exception& error) {
    return fail(fmt::format("{} (this is a bug, please report it)", error.what()));
  }
}
