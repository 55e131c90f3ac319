#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace mstsl::io {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

inline std::string_view as_text(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
inline ByteView as_bytes(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }

template <typename T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

/// The number with its bytes in the other order.
template <Number T>
T swap_bytes(T value) {
  std::byte bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <Number T>
T from_order(T value, std::endian order) {
  return order == std::endian::native ? value : swap_bytes(value);
}

/// Takes numbers and pieces from the front of bytes that nobody has checked. The first request that goes past
/// the end makes it fail for good: from then on it gives zeros and empty pieces, so that a caller may read a
/// whole record and ask ok() once.
class ByteCursor {
 public:
  explicit ByteCursor(ByteView bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return ok_ ? bytes_.size() - position_ : 0; }
  void fail() { ok_ = false; }

  ByteView take(std::uint64_t size) {
    if (size > remaining()) ok_ = false;
    if (!ok_) return {};
    const ByteView piece = bytes_.subspan(position_, static_cast<std::size_t>(size));
    position_ += piece.size();
    return piece;
  }

  template <Number T>
  T number(std::endian order = std::endian::little) {
    T value{};
    const ByteView piece = take(sizeof(T));
    if (ok_) std::memcpy(&value, piece.data(), sizeof(T));
    return from_order(value, order);
  }

  /// A piece that is preceded by its length.
  template <std::unsigned_integral Length>
  ByteView sized() {
    return take(number<Length>());
  }

  /// Text that is preceded by its length in 32 bits.
  std::string_view text() { return as_text(sized<std::uint32_t>()); }

 private:
  ByteView bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

/// Appends little-endian numbers and pieces to bytes.
class ByteBuilder {
 public:
  template <Number T>
  void number(T value) {
    value = from_order(value, std::endian::little);
    append(std::as_bytes(std::span(&value, 1)));
  }
  /// Not inlined: GCC 14 would see overflows in it that are not there, wherever a size is known.
  [[gnu::noinline]] void append(ByteView piece) { bytes_.insert(bytes_.end(), piece.begin(), piece.end()); }
  template <std::unsigned_integral Length>
  void sized(ByteView piece) {
    number(static_cast<Length>(piece.size()));
    append(piece);
  }
  void text(std::string_view text) { sized<std::uint32_t>(as_bytes(text)); }

  const Bytes& bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  Bytes bytes_;
};

}  // namespace mstsl::io
