#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mstsl::io {

/// More pixels than any map has (820 m squared at 5 cm), yet they fit in memory: larger headers are believed
/// by no one.
inline constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;

/// A picture, 8 bit a sample, its samples side by side, the top row first.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 1;  ///< 1 gray, 3 RGB, 4 RGB and alpha (255 is opaque)
  std::vector<std::uint8_t> samples;
};

/// An image of the given size, all samples 0; throws FileProblem for a size that no map has.
Image make_image(std::uint64_t width, std::uint64_t height, int channels);

/// Decodes PGM (P2, P5), PNG or BMP, told apart by their first bytes; throws FileProblem.
Image decode_image(std::string_view bytes);
Image decode_pgm(std::string_view bytes);
Image decode_png(std::string_view bytes);
Image decode_bmp(std::string_view bytes);

/// A gray image as binary PGM (P5).
std::string encode_pgm(const Image& image);

}  // namespace mstsl::io
