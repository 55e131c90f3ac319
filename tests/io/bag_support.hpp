#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mstsl/core/stamp.hpp"

#include "io/bytes.hpp"

namespace mstsl::test {

/// Writes ROS 1 bags by the words of the format's description, as a double of Debian's rosbag where that is
/// absent (the interop tests hold the reader against rosbag itself).
class BagBuilder {
 public:
  struct Options {
    bool chunked = true;
    bool indexed = true;
  };

  explicit BagBuilder(Options options) : options_(options) {
    out_ = "#ROSBAG V2.0\n";
    out_ += header(0, 0, 0);
  }

  void connect(std::uint32_t id, const std::string& topic, const std::string& type) {
    const std::string record = connection(id, topic, type);
    connections_ += record;
    ++connection_count_;
    (options_.chunked ? chunk_ : out_) += record;
  }
  void write(std::uint32_t id, Stamp time, std::string_view data) {
    const std::string message = record(
        field("op", number<std::uint8_t>(2)) + field("conn", number(id)) + field("time", stamp(time)), data);
    (options_.chunked ? chunk_ : out_) += message;
    ++counts_[id];
    if (first_.ns == 0) first_ = time;
    last_ = time;
  }
  void end_chunk() {
    if (chunk_.empty()) return;
    const std::uint64_t position = out_.size();
    out_ += record(field("op", number<std::uint8_t>(5)) + field("compression", "none") +
                       field("size", number(static_cast<std::uint32_t>(chunk_.size()))),
                   chunk_);
    std::string counts;
    for (const auto& [id, count] : counts_) counts += number(id) + number(count);
    infos_ += record(field("op", number<std::uint8_t>(6)) + field("ver", number<std::uint32_t>(1)) +
                         field("chunk_pos", number(position)) + field("start_time", stamp(first_)) +
                         field("end_time", stamp(last_)) +
                         field("count", number(static_cast<std::uint32_t>(counts_.size()))),
                     counts);
    ++chunk_count_;
    chunk_.clear();
    counts_.clear();
    first_ = {};
  }
  std::string finish() {
    end_chunk();
    if (!options_.indexed) return out_;
    const std::uint64_t index = out_.size();
    out_ += connections_ + infos_;
    const std::string filled = header(index, connection_count_, chunk_count_);
    return out_.replace(13, filled.size(), filled);
  }

  template <typename T>
  static std::string number(T value) {
    io::ByteBuilder builder;
    builder.number(value);
    return std::string(io::as_text(builder.bytes()));
  }
  static std::string field(const std::string& name, const std::string& value) {
    return number(static_cast<std::uint32_t>(name.size() + 1 + value.size())) + name + "=" + value;
  }
  static std::string record(const std::string& header, std::string_view data) {
    return number(static_cast<std::uint32_t>(header.size())) + header +
           number(static_cast<std::uint32_t>(data.size())) + std::string(data);
  }

 private:
  static std::string stamp(Stamp time) {
    return number(static_cast<std::uint32_t>(time.ns / 1'000'000'000)) +
           number(static_cast<std::uint32_t>(time.ns % 1'000'000'000));
  }
  static std::string connection(std::uint32_t id, const std::string& topic, const std::string& type) {
    return record(field("op", number<std::uint8_t>(7)) + field("conn", number(id)) + field("topic", topic),
                  field("topic", topic) + field("type", type) + field("md5sum", "*") +
                      field("message_definition", "any"));
  }
  static std::string header(std::uint64_t index, std::uint32_t connections, std::uint32_t chunks) {
    const std::string fields = field("op", number<std::uint8_t>(3)) + field("index_pos", number(index)) +
                               field("conn_count", number(connections)) +
                               field("chunk_count", number(chunks));
    return record(fields, std::string(4096 - 8 - fields.size(), ' '));
  }

  Options options_;
  std::string out_, chunk_, connections_, infos_;
  std::map<std::uint32_t, std::uint32_t> counts_;
  std::uint32_t connection_count_ = 0, chunk_count_ = 0;
  Stamp first_, last_;
};

}  // namespace mstsl::test
