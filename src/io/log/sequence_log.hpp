#pragma once

#include <memory>
#include <vector>

#include "io/log/message_log.hpp"

namespace mstsl::io {

/// One recording that its recorder split into several files.
class SequenceLog final : public MessageLog {
 public:
  explicit SequenceLog(std::vector<std::unique_ptr<MessageLog>> parts);

  const std::vector<Channel>& channels() const override { return channels_; }
  std::optional<TimeSpan> time_span() const override;
  void read(const Wanted& wanted, const Visit& visit, PlayReport* report) override;

 private:
  std::vector<std::unique_ptr<MessageLog>> parts_;  ///< in the order of their times
  std::vector<Channel> channels_;                   ///< of all parts, each topic once
};

}  // namespace mstsl::io
