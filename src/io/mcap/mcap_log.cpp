#include "io/mcap/mcap_log.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "io/compression.hpp"
#include "io/mcap/chunk.hpp"
#include "io/mcap/record_stream.hpp"
#include "io/mcap/summary.hpp"
#include "io/ros/schemas.hpp"

namespace mstsl::io {
namespace {

using mcap::Opcode;

ros::Encoding encoding_from(const std::string& name) {
  if (name == "cdr") return ros::Encoding::kCdr;
  if (name == "ros1") return ros::Encoding::kRos1;
  return ros::Encoding::kOther;
}

class McapLog final : public MessageLog {
 public:
  McapLog(InputFile file, mcap::Summary summary) : file_(std::move(file)), summary_(std::move(summary)) {
    for (const auto& [id, channel] : summary_.channels) {
      const auto schema = summary_.schemas.find(channel.schema_id);
      const auto& counts = summary_.statistics.channel_message_counts;
      const auto count = counts.find(id);
      position_[id] = channels_.size();
      channels_.push_back(
          {channel.topic, schema == summary_.schemas.end() ? "" : ros::plain_type_name(schema->second.name),
           encoding_from(channel.message_encoding), count == counts.end() ? 0 : count->second});
    }
  }

  const std::vector<Channel>& channels() const override { return channels_; }

  std::optional<TimeSpan> time_span() const override {
    const mcap::Statistics& statistics = summary_.statistics;
    if (statistics.message_count == 0) return std::nullopt;
    return TimeSpan{{static_cast<std::int64_t>(statistics.start_time)},
                    {static_cast<std::int64_t>(statistics.end_time)}};
  }

  void read(const Wanted& wanted, const Visit& visit, PlayReport* report) override;

 private:
  class Pass;
  InputFile file_;
  mcap::Summary summary_;
  std::vector<Channel> channels_;
  std::map<std::uint16_t, std::size_t> position_;  ///< of a channel id in channels_
};

/// One reading of the file.
class McapLog::Pass {
 public:
  Pass(const McapLog& log, const Wanted& wanted, const Visit& visit, PlayReport* report)
      : log_(log), visit_(visit), report_(report), stream_(log.file_, mcap::kMagic.size(), sums_up()) {
    for (const auto& [id, position] : log_.position_)
      if (wanted(log_.channels_[position])) wanted_.insert(id);
  }

  void run();

 private:
  bool sums_up() const { return report_ != nullptr && log_.summary_.data_crc != 0; }
  void note(const std::string& problem) {
    if (report_ != nullptr) ++report_->problems[problem];
  }
  void warn(std::string sentence) {
    if (report_ != nullptr) report_->warnings.push_back(std::move(sentence));
  }

  bool may_hold_wanted(std::uint64_t chunk_offset) const;
  /// In a look ahead: goes to the next chunk that may hold wanted messages; false when there is none.
  bool skip_to_wanted_chunk(std::uint64_t from);
  /// After damage: goes to the next chunk that the index knows; false when there is none.
  bool skip_damage(std::uint64_t from);
  void visit_chunk(const mcap::Record& record);
  void visit_records(ByteView records);
  void deliver(const mcap::Message& message);
  void end_of_data(const mcap::Record& record);

  const McapLog& log_;
  const Visit& visit_;
  PlayReport* report_;
  mcap::RecordStream stream_;
  std::set<std::uint16_t> wanted_;
  Decompressor decompressor_;
  std::vector<mcap::Message> messages_;  ///< of the chunk at hand
  bool stopped_ = false;
};

bool McapLog::Pass::may_hold_wanted(std::uint64_t chunk_offset) const {
  const auto found = log_.summary_.chunks.find(chunk_offset);
  if (found == log_.summary_.chunks.end() || found->second.message_index_offsets.empty()) return true;
  return std::ranges::any_of(found->second.message_index_offsets,
                             [this](const auto& entry) { return wanted_.contains(entry.first); });
}

bool McapLog::Pass::skip_to_wanted_chunk(std::uint64_t from) {
  for (auto chunk = log_.summary_.chunks.lower_bound(from); chunk != log_.summary_.chunks.end(); ++chunk) {
    if (!may_hold_wanted(chunk->first)) continue;
    stream_.seek(chunk->first);
    return true;
  }
  return false;
}

bool McapLog::Pass::skip_damage(std::uint64_t from) {
  const auto chunk = log_.summary_.chunks.upper_bound(from);
  if (chunk == log_.summary_.chunks.end()) return false;
  note("damaged stretches skipped");
  stream_.seek(chunk->first);
  return true;
}

void McapLog::Pass::run() {
  const bool look_ahead = report_ == nullptr && !log_.summary_.chunks.empty();
  if (look_ahead && !skip_to_wanted_chunk(0)) return;
  while (!stopped_) {
    std::optional<mcap::Record> record = stream_.next();
    if (!record || record->opcode == Opcode::kFooter) break;
    if (record->opcode == Opcode::kDataEnd) return end_of_data(*record);
    const bool is_chunk = record->opcode == Opcode::kChunk && may_hold_wanted(record->offset);
    const bool is_message = record->opcode == Opcode::kMessage;
    if (is_chunk || is_message) stream_.load(*record);
    if (is_chunk) visit_chunk(*record);
    const bool whole = record->content_size <= log_.file_.size() - record->offset - mcap::kRecordHeadSize;
    if (is_message && whole) {
      if (const std::optional<mcap::Message> message = mcap::parse_message(record->content))
        deliver(*message);
    }
    if (!whole && !skip_damage(record->offset)) break;
    if (look_ahead && !skip_to_wanted_chunk(record->offset + 1)) return;
  }
  if (!stopped_)
    warn(
        fmt::format("{}: the log ends in the middle (its recording was cut off?); it was played to its last "
                    "whole message",
                    log_.file_.name()));
}

void McapLog::Pass::visit_chunk(const mcap::Record& record) {
  const std::optional<mcap::Chunk> chunk = mcap::parse_chunk(record.content);
  if (!chunk) return;
  const mcap::UnpackedChunk unpacked = mcap::unpack(*chunk, decompressor_);
  if (!unpacked.problem.empty()) note(unpacked.problem);
  visit_records(unpacked.records);
}

/// Writers put messages into a chunk as they come; they are visited by the time at which they were recorded.
void McapLog::Pass::visit_records(ByteView records) {
  messages_.clear();
  mcap::for_each_record(records, [this](Opcode opcode, ByteView content) {
    if (opcode != Opcode::kMessage) return;
    const std::optional<mcap::Message> message = mcap::parse_message(content);
    if (message && wanted_.contains(message->channel_id)) messages_.push_back(*message);
  });
  if (!std::ranges::is_sorted(messages_, {}, &mcap::Message::log_time))
    std::ranges::stable_sort(messages_, {}, &mcap::Message::log_time);
  for (const mcap::Message& message : messages_)
    if (!stopped_) deliver(message);
}

void McapLog::Pass::deliver(const mcap::Message& message) {
  if (!wanted_.contains(message.channel_id)) return;
  const Channel& channel = log_.channels_[log_.position_.at(message.channel_id)];
  stopped_ = !visit_({&channel, {static_cast<std::int64_t>(message.log_time)}, message.data});
}

void McapLog::Pass::end_of_data(const mcap::Record& record) {
  if (log_.summary_.is_damaged)
    warn(fmt::format("{}: the index at the end of the log is damaged; the log was read from front to back",
                     log_.file_.name()));
  const std::optional<std::uint32_t> crc = stream_.crc_before();
  if (crc && *crc != log_.summary_.data_crc)
    warn(fmt::format("{}: the check sum of its data ({} bytes) is wrong; some of it may be damaged",
                     log_.file_.name(), record.offset));
}

void McapLog::read(const Wanted& wanted, const Visit& visit, PlayReport* report) {
  Pass(*this, wanted, visit, report).run();
}

}  // namespace

bool is_mcap(const InputFile& file) {
  Bytes head(mcap::kMagic.size());
  return file.read_at(0, head) && as_text(head) == mcap::kMagic;
}

Result<std::unique_ptr<MessageLog>> open_mcap(InputFile file) {
  if (!is_mcap(file)) return Error(fmt::format("{}: is not an MCAP file of format version 0", file.name()));
  mcap::Summary summary = mcap::summarize(file);
  return std::unique_ptr<MessageLog>(std::make_unique<McapLog>(std::move(file), std::move(summary)));
}

}  // namespace mstsl::io
