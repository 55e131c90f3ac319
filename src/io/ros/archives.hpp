#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "io/bytes.hpp"
#include "io/ros/fields.hpp"

namespace mstsl::io::ros {

/// ROS 1's rules: packed little-endian numbers, lengths in 32 bits, a sequence number in each header.
class Ros1Layout {
 public:
  explicit Ros1Layout(ByteView bytes) : cursor_(bytes) {}

  template <Number T>
  T number() {
    return cursor_.number<T>();
  }
  std::string_view text() { return cursor_.text(); }
  std::int64_t seconds() { return number<std::uint32_t>(); }
  void sequence_number() { number<std::uint32_t>(); }
  ByteCursor& cursor() { return cursor_; }
  static constexpr std::endian order() { return std::endian::little; }

 private:
  ByteCursor cursor_;
};

/// ROS 2's rules (OMG CDR, as DDS-RTPS wraps it): two bytes that name the byte order, two of options, then
/// numbers aligned to their own size counted from there; texts count their closing zero.
class CdrLayout {
 public:
  explicit CdrLayout(ByteView bytes) : cursor_(bytes) {
    const auto kind = cursor_.number<std::uint16_t>(std::endian::big);
    cursor_.number<std::uint16_t>();
    if (kind > 1) cursor_.fail();
    order_ = kind == 0 ? std::endian::big : std::endian::little;
  }

  template <Number T>
  T number() {
    align(sizeof(T));
    return cursor_.number<T>(order_);
  }
  std::string_view text() {
    std::string_view text = as_text(cursor_.take(number<std::uint32_t>()));
    if (!text.empty() && text.back() == '\0') text.remove_suffix(1);
    return text;
  }
  std::int64_t seconds() { return number<std::int32_t>(); }
  void sequence_number() {}
  ByteCursor& cursor() { return cursor_; }
  std::endian order() const { return order_; }

 private:
  void align(std::size_t size) {
    constexpr std::size_t kEncapsulation = 4;
    if (!cursor_.ok()) return;
    cursor_.take((size - (cursor_.position() - kEncapsulation) % size) % size);
  }

  ByteCursor cursor_;
  std::endian order_ = std::endian::little;
};

/// Fills messages by the rules of a Layout.
template <typename Layout>
class Reader {
 public:
  explicit Reader(ByteView bytes) : layout_(bytes) {}

  bool ok() { return layout_.cursor().ok(); }

  template <typename... Fields>
  void operator()(Fields&... parts) {
    (read(parts), ...);
  }
  void sequence_number() { layout_.sequence_number(); }

 private:
  template <Number T>
  void read(T& value) {
    value = layout_.template number<T>();
  }
  void read(std::string& value) { value = layout_.text(); }
  void read(Time& value) {
    value.sec = layout_.seconds();
    read(value.nanosec);
  }
  template <Number T, std::size_t N>
  void read(std::array<T, N>& values) {
    for (T& value : values) read(value);
  }
  void read(std::vector<float>& values) {
    const auto count = layout_.template number<std::uint32_t>();
    const ByteView bytes = layout_.cursor().take(std::uint64_t{count} * sizeof(float));
    values.resize(bytes.size() / sizeof(float));
    if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    if (layout_.order() != std::endian::native)
      for (float& value : values) value = swap_bytes(value);
  }
  /// Each element takes at least a byte, so a count beyond the bytes left is a lie; and no room is made for
  /// elements before they are read.
  template <typename Message>
  void read(std::vector<Message>& messages) {
    const auto count = layout_.template number<std::uint32_t>();
    if (count > layout_.cursor().remaining()) layout_.cursor().fail();
    for (std::uint32_t i = 0; i < count && ok(); ++i) read(messages.emplace_back());
  }
  template <typename Message>
  void read(Message& message) {
    fields(*this, message);
  }

  Layout layout_;
};

/// Writes messages as little-endian CDR.
class CdrWriter {
 public:
  CdrWriter() { out_.append(as_bytes(std::string_view("\0\1\0\0", 4))); }

  template <typename... Fields>
  void operator()(Fields&... parts) {
    (write(parts), ...);
  }
  void sequence_number() {}
  const Bytes& bytes() const { return out_.bytes(); }

 private:
  template <Number T>
  void put(T value) {
    while (out_.bytes().size() % sizeof(T) != 4 % sizeof(T)) out_.number(std::uint8_t{0});
    out_.number(value);
  }
  template <Number T>
  void write(T& value) {
    put(value);
  }
  void write(std::string& value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    out_.append(as_bytes(value));
    put(std::uint8_t{0});
  }
  void write(Time& value) {
    put(static_cast<std::int32_t>(value.sec));
    put(value.nanosec);
  }
  template <typename T, std::size_t N>
  void write(std::array<T, N>& values) {
    for (T& value : values) write(value);
  }
  template <typename T>
  void write(std::vector<T>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    for (T& value : values) write(value);
  }
  template <typename Message>
  void write(Message& message) {
    fields(*this, message);
  }

  ByteBuilder out_;
};

}  // namespace mstsl::io::ros
