#include <algorithm>
#include <array>
#include <bit>

#include "file_problem.hpp"
#include "image.hpp"

namespace mstsl::io {
namespace {

// Field offsets and constants after Microsoft's "Bitmap Storage": BITMAPFILEHEADER, BITMAPINFOHEADER,
// BITMAPV4HEADER.
constexpr std::size_t kFileHeaderBytes = 14;
constexpr std::size_t kInfoHeaderBytes = 40;
constexpr std::size_t kV4HeaderBytes = 108;
constexpr std::uint32_t kUncompressed = 0;
constexpr std::uint32_t kBitFields = 3;

/// Little-endian numbers at byte offsets; throws FileProblem beyond the end.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
  std::uint32_t u8(std::size_t at) const {
    if (at >= bytes_.size()) throw FileProblem("the BMP image is cut off at byte {}", bytes_.size());
    return static_cast<unsigned char>(bytes_[at]);
  }
  std::uint32_t u16(std::size_t at) const { return u8(at) | u8(at + 1) << 8; }
  std::uint32_t u32(std::size_t at) const { return u16(at) | u16(at + 2) << 16; }
  std::size_t size() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

struct Header {
  std::uint64_t width, height;
  bool top_down;
  std::uint32_t bits, compression;
  std::size_t palette_at, palette_colors, pixels_at;
  std::array<int, 4> shift;  // of red, green, blue, alpha in a 32-bit pixel; alpha -1 where there is none
};

int byte_shift(std::uint32_t mask) {
  const int shift = mask == 0 ? -1 : std::countr_zero(mask);
  if (mask != 0 && (shift % 8 != 0 || mask >> shift != 0xff))
    throw FileProblem("the BMP image packs its colours in an unusual way (mask {:#010x}); save it as PNG",
                      mask);
  return shift;
}

std::array<int, 4> color_shifts(const Bytes& bytes, std::uint32_t header_bytes, std::uint32_t compression) {
  if (compression != kBitFields) return {16, 8, 0, -1};
  const std::size_t masks_at = kFileHeaderBytes + kInfoHeaderBytes;
  std::array<int, 4> shifts{};
  for (std::size_t i = 0; i < 4; ++i)
    shifts[i] = i < 3 || header_bytes >= kV4HeaderBytes ? byte_shift(bytes.u32(masks_at + 4 * i)) : -1;
  if (std::any_of(shifts.begin(), shifts.begin() + 3, [](int shift) { return shift < 0; }))
    throw FileProblem("the BMP image gives no place to one of its colours; save it as PNG");
  return shifts;
}

Header read_header(const Bytes& bytes) {
  const std::uint32_t header_bytes = bytes.u32(kFileHeaderBytes);
  if (header_bytes < kInfoHeaderBytes || header_bytes > 1024)
    throw FileProblem("the BMP image has a header of {} bytes, which no known kind has; save it as PNG",
                      header_bytes);
  Header header{};
  const auto width = static_cast<std::int32_t>(bytes.u32(18));
  const auto height = static_cast<std::int32_t>(bytes.u32(22));
  if (width <= 0 || height == 0) throw FileProblem("the BMP image has no pixels ({} x {})", width, height);
  header.width = static_cast<std::uint64_t>(width);
  header.height = static_cast<std::uint64_t>(std::abs(std::int64_t{height}));
  header.top_down = height < 0;
  header.bits = bytes.u16(28);
  header.compression = bytes.u32(30);
  const bool known_bits =
      header.bits == 1 || header.bits == 4 || header.bits == 8 || header.bits == 24 || header.bits == 32;
  const bool plain =
      header.compression == kUncompressed || (header.compression == kBitFields && header.bits == 32);
  if (!known_bits || !plain)
    throw FileProblem(
        "the BMP image has {} bits a pixel and compression {}; only uncompressed 1, 4, 8, 24 and 32 bits "
        "are read: save it as PNG",
        header.bits, header.compression);
  header.palette_at = kFileHeaderBytes + header_bytes;
  const std::uint32_t colors = bytes.u32(46);
  const std::uint32_t most = header.bits <= 8 ? 1U << header.bits : 0;
  header.palette_colors = colors == 0 ? most : std::min(colors, most);
  header.pixels_at = bytes.u32(10);
  header.shift = color_shifts(bytes, header_bytes, header.compression);
  return header;
}

/// The pixel as bytes red, green, blue, alpha from the lowest.
std::uint32_t pixel(const Bytes& bytes, const Header& header, std::size_t row_at, std::size_t column) {
  if (header.bits == 24) {
    const std::size_t at = row_at + 3 * column;
    return bytes.u8(at + 2) | bytes.u8(at + 1) << 8 | bytes.u8(at) << 16 | 0xff000000U;
  }
  if (header.bits == 32) {
    const std::uint32_t packed = bytes.u32(row_at + 4 * column);
    std::uint32_t rgba = header.shift[3] < 0 ? 0xff000000U : 0;
    for (int i = 0; i < 4; ++i)
      if (header.shift[i] >= 0) rgba |= (packed >> header.shift[i] & 0xffU) << (8 * i);
    return rgba;
  }
  const std::size_t per_byte = 8 / header.bits;
  const std::size_t shift = 8 - header.bits * (column % per_byte + 1);
  const std::uint32_t index = bytes.u8(row_at + column / per_byte) >> shift & ((1U << header.bits) - 1);
  if (index >= header.palette_colors)
    throw FileProblem("the BMP image uses colour {} of a palette that has {}", index, header.palette_colors);
  const std::size_t at = header.palette_at + 4 * index;
  return bytes.u8(at + 2) | bytes.u8(at + 1) << 8 | bytes.u8(at) << 16 | 0xff000000U;
}

}  // namespace

Image decode_bmp(std::string_view file) {
  const Bytes bytes(file);
  const Header header = read_header(bytes);
  const std::uint64_t stride = (header.width * header.bits + 31) / 32 * 4;  // rows end on 4 bytes
  if (header.pixels_at > bytes.size() || stride * header.height > bytes.size() - header.pixels_at)
    throw FileProblem("the BMP image is cut off: {} x {} pixels need {} bytes, it has {}", header.width,
                      header.height, header.pixels_at + stride * header.height, bytes.size());
  const std::size_t channels = header.shift[3] < 0 ? 3 : 4;
  Image image = make_image(header.width, header.height, static_cast<int>(channels));
  std::size_t out = 0;
  for (std::uint64_t y = 0; y < header.height; ++y) {
    const std::size_t row_at = header.pixels_at + stride * (header.top_down ? y : header.height - 1 - y);
    for (std::size_t x = 0; x < header.width; ++x) {
      const std::uint32_t rgba = pixel(bytes, header, row_at, x);
      for (std::size_t k = 0; k < channels; ++k)
        image.samples[out++] = static_cast<std::uint8_t>(rgba >> (8 * k));
    }
  }
  return image;
}

}  // namespace mstsl::io
