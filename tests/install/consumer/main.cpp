#include <cstdio>

#include "mstsl/io/recording.hpp"
#include "mstsl/localize/localizer.hpp"

/// The smallest program a user of the installed library writes: it links, and an error is a sentence.
int main() {
  const auto report = mstsl::io::play(
      {"no-such-log.mcap"}, {}, [](const auto&) {}, [](const auto&) { return true; });
  if (report.ok()) return 1;
  std::printf("%s\n", report.error().message().c_str());
  return 0;
}
