#include "io/bag/bag_log.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "io/bag/index.hpp"
#include "io/bag/record_stream.hpp"

namespace mstsl::io {
namespace {

using bag::Op;

class BagLog final : public MessageLog {
 public:
  BagLog(InputFile file, bag::Index index, bool has_index)
      : file_(std::move(file)), index_(std::move(index)), has_index_(has_index) {
    for (const auto& [id, connection] : index_.connections) {
      const auto count = index_.message_counts.find(id);
      position_[id] = channels_.size();
      channels_.push_back({connection.topic, connection.type, ros::Encoding::kRos1,
                           count == index_.message_counts.end() ? 0 : count->second});
    }
  }

  const std::vector<Channel>& channels() const override { return channels_; }

  std::optional<TimeSpan> time_span() const override {
    if (!index_.first) return std::nullopt;
    return TimeSpan{*index_.first, *index_.last};
  }

  void read(const Wanted& wanted, const Visit& visit, PlayReport* report) override;

 private:
  class Pass;
  InputFile file_;
  bag::Index index_;
  bool has_index_;
  std::vector<Channel> channels_;
  std::map<std::uint32_t, std::size_t> position_;  ///< of a connection in channels_
};

/// One reading of the bag.
class BagLog::Pass {
 public:
  Pass(const BagLog& log, const Wanted& wanted, const Visit& visit, PlayReport* report)
      : log_(log), visit_(visit), report_(report), stream_(log.file_, bag::kMagic.size()) {
    for (const auto& [id, position] : log_.position_)
      if (wanted(log_.channels_[position])) wanted_.insert(id);
  }

  void run();

 private:
  /// False when the record's data are cut short.
  bool visit_record(const bag::Record& record);
  bool may_hold_wanted(std::uint64_t chunk_position) const;
  /// Goes on at the first chunk that the index knows behind `from`; false when there is none.
  bool skip_to_chunk(std::uint64_t from, bool wanted_only);
  void visit_chunk(const bag::Record& record);
  void visit_messages(ByteView records);
  void note(const char* problem) {
    if (report_ != nullptr) ++report_->problems[problem];
  }

  const BagLog& log_;
  const Visit& visit_;
  PlayReport* report_;
  bag::RecordStream stream_;
  std::set<std::uint32_t> wanted_;
  Decompressor decompressor_;
  std::vector<bag::Message> messages_;  ///< of the chunk at hand
  bool stopped_ = false;
};

void BagLog::Pass::run() {
  const bool look_ahead = report_ == nullptr && log_.has_index_;
  if (look_ahead && !skip_to_chunk(0, true)) return;
  bool broken = false;
  while (!stopped_) {
    const std::uint64_t place = stream_.next_offset();
    const std::optional<bag::Record> record = stream_.next();
    if (!record && place >= log_.file_.size()) break;
    const bool whole = record && visit_record(*record);
    if (stopped_) return;
    if (look_ahead && !skip_to_chunk(place + 1, true)) return;
    if (whole) continue;
    broken = !skip_to_chunk(place + 1, false);
    if (broken) break;
    note("damaged stretches skipped");
  }
  if (report_ == nullptr || stopped_) return;
  if (broken || !log_.has_index_)
    report_->warnings.push_back(fmt::format(
        "{}: the bag {}; it was played to its last whole message", log_.file_.name(),
        broken ? "ends in the middle or is damaged there" : "was never closed, so it has no index"));
}

bool BagLog::Pass::visit_record(const bag::Record& record) {
  const Op op = record.fields.op();
  if (op == Op::kChunk && may_hold_wanted(record.offset)) visit_chunk(record);
  if (op == Op::kMessage) {
    const ByteView data = stream_.load(record);
    const std::optional<bag::Message> message = bag::parse_message(record.fields, data);
    if (message && data.size() == record.data_size && wanted_.contains(message->connection))
      stopped_ =
          !visit_({&log_.channels_[log_.position_.at(message->connection)], message->time, message->data});
  }
  return stream_.is_whole(record);
}

bool BagLog::Pass::may_hold_wanted(std::uint64_t chunk_position) const {
  const auto found = log_.index_.chunks.find(chunk_position);
  if (found == log_.index_.chunks.end()) return true;
  return std::ranges::any_of(found->second.message_counts,
                             [this](const auto& entry) { return wanted_.contains(entry.first); });
}

bool BagLog::Pass::skip_to_chunk(std::uint64_t from, bool wanted_only) {
  for (auto chunk = log_.index_.chunks.lower_bound(from); chunk != log_.index_.chunks.end(); ++chunk) {
    if (wanted_only && !may_hold_wanted(chunk->first)) continue;
    stream_.seek(chunk->first);
    return true;
  }
  return false;
}

void BagLog::Pass::visit_chunk(const bag::Record& record) {
  const ByteView data = stream_.load(record);
  const Decompressor::Output unpacked = bag::unpack(record.fields, data, decompressor_);
  if (!unpacked.whole) note("chunks cut short");
  visit_messages(unpacked.bytes);
}

void BagLog::Pass::visit_messages(ByteView records) {
  messages_.clear();
  bag::for_each_record(records, [this](const bag::Fields& fields, ByteView data) {
    if (fields.op() != Op::kMessage) return;
    const std::optional<bag::Message> message = bag::parse_message(fields, data);
    if (message && wanted_.contains(message->connection)) messages_.push_back(*message);
  });
  if (!std::ranges::is_sorted(messages_, {}, &bag::Message::time))
    std::ranges::stable_sort(messages_, {}, &bag::Message::time);
  for (const bag::Message& message : messages_) {
    if (stopped_) return;
    stopped_ = !visit_({&log_.channels_[log_.position_.at(message.connection)], message.time, message.data});
  }
}

void BagLog::read(const Wanted& wanted, const Visit& visit, PlayReport* report) {
  Pass(*this, wanted, visit, report).run();
}

std::string head_of(const InputFile& file) {
  Bytes head(bag::kMagic.size());
  return file.read_at(0, head) ? std::string(as_text(head)) : std::string();
}

}  // namespace

bool is_bag(const InputFile& file) { return head_of(file).starts_with(bag::kAnyMagic); }

Result<std::unique_ptr<MessageLog>> open_bag(InputFile file) {
  if (head_of(file) != bag::kMagic)
    return Error(fmt::format(
        "{}: is a bag of another version than 2.0; convert it with ROS 1's 'rosbag migrate'", file.name()));
  std::optional<bag::Index> index = bag::read_index(file);
  const bool has_index = index.has_value();
  if (!index) index = bag::scan_index(file);
  return std::unique_ptr<MessageLog>(std::make_unique<BagLog>(std::move(file), *std::move(index), has_index));
}

}  // namespace mstsl::io
