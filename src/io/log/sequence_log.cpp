#include "io/log/sequence_log.hpp"

#include <algorithm>
#include <utility>

namespace mstsl::io {

SequenceLog::SequenceLog(std::vector<std::unique_ptr<MessageLog>> parts) : parts_(std::move(parts)) {
  std::ranges::stable_sort(parts_, {}, [](const std::unique_ptr<MessageLog>& part) {
    const std::optional<TimeSpan> span = part->time_span();
    return span ? span->first : Stamp{};
  });
  for (const auto& part : parts_) {
    for (const Channel& channel : part->channels()) {
      const auto known = std::ranges::find_if(channels_, [&channel](const Channel& other) {
        return other.topic == channel.topic && other.type == channel.type &&
               other.encoding == channel.encoding;
      });
      if (known == channels_.end())
        channels_.push_back(channel);
      else
        known->message_count += channel.message_count;
    }
  }
}

std::optional<MessageLog::TimeSpan> SequenceLog::time_span() const {
  std::optional<TimeSpan> whole;
  for (const auto& part : parts_) {
    const std::optional<TimeSpan> span = part->time_span();
    if (span && whole)
      whole = TimeSpan{std::min(whole->first, span->first), std::max(whole->last, span->last)};
    if (span && !whole) whole = span;
  }
  return whole;
}

void SequenceLog::read(const Wanted& wanted, const Visit& visit, PlayReport* report) {
  bool goes_on = true;
  const Visit watched = [&](const RawMessage& message) { return goes_on = visit(message); };
  for (const auto& part : parts_)
    if (goes_on) part->read(wanted, watched, report);
}

}  // namespace mstsl::io
