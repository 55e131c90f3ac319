#pragma once

#include <algorithm>
#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace mstsl::test {

struct Printed {
  int exit_status = -1;  ///< 128 + n where signal n ended it
  std::string text;      ///< stdout and stderr together

  auto lines() const { return std::count(text.begin(), text.end(), '\n'); }
  bool says(const std::string& words) const { return text.find(words) != std::string::npos; }
};

/// Runs a shell command.
inline Printed run_shell(const std::string& command) {
  Printed printed;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return printed;
  char piece[4096];
  for (std::size_t got; (got = std::fread(piece, 1, sizeof piece, pipe)) > 0;)
    printed.text.append(piece, got);
  const int status = pclose(pipe);
  printed.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return printed;
}

/// Runs the mstsl program as a user would.
inline Printed run_app(const std::string& arguments) {
  return run_shell(std::string(MSTSL_APP) + " " + arguments);
}

}  // namespace mstsl::test
