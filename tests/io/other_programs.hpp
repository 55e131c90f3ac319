#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace mstsl::test {

/// What another program prints on stdout and stderr together, and how it ended.
struct Output {
  int status = -1;
  std::string text;
};

inline Output run_program(const std::string& command) {
  Output output;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return output;
  char piece[4096];
  for (std::size_t got; (got = std::fread(piece, 1, sizeof piece, pipe)) > 0;) output.text.append(piece, got);
  output.status = pclose(pipe);
  return output;
}

}  // namespace mstsl::test

/// Skips the test where a program of others is not installed.
#define MSTSL_REQUIRE_PROGRAM(probe, package) \
  if (mstsl::test::run_program(probe).status != 0) GTEST_SKIP() << "not installed here: " << package
