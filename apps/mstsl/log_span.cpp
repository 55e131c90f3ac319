#include "log_span.hpp"

#include <algorithm>

#include "mstsl/io/recording_info.hpp"

namespace mstsl::app {

double LogSpan::share(Stamp now) const { return std::clamp((now - begin) / seconds, 0.0, 1.0); }

std::optional<LogSpan> span_of(const std::vector<std::filesystem::path>& logs) {
  const auto first = io::describe_recording(logs.front()), last = io::describe_recording(logs.back());
  if (!first || !last || !first->first || !last->last) return std::nullopt;
  constexpr double kShortest_s = 1e-3;
  return LogSpan{*first->first, std::max(*last->last - *first->first, kShortest_s)};
}

}  // namespace mstsl::app
