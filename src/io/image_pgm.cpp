#include <algorithm>
#include <cassert>
#include <cctype>

#include <fmt/format.h>

#include "file_problem.hpp"
#include "image.hpp"

namespace mstsl::io {
namespace {

/// Reads the white-space separated numbers of a netpbm file, comments passed over.
class Tokens {
 public:
  explicit Tokens(std::string_view bytes) : bytes_(bytes) {}

  /// The next number; throws FileProblem naming `what` where there is none.
  std::uint32_t number(std::string_view what) {
    skip_space();
    constexpr std::uint32_t kLimit = 1'000'000'000;
    const std::size_t start = at_;
    std::uint32_t value = 0;
    for (; at_ < bytes_.size() && bytes_[at_] >= '0' && bytes_[at_] <= '9'; ++at_)
      value = std::min(kLimit, value * 10 + static_cast<std::uint32_t>(bytes_[at_] - '0'));
    if (at_ == start && at_ == bytes_.size())
      throw FileProblem("the PGM image is cut off before its {}", what);
    if (at_ == start)
      throw FileProblem("the PGM image has no number at byte {}, where its {} belongs", at_, what);
    return value;
  }

  /// What follows the single white space after the header.
  std::string_view raster() const { return bytes_.substr(std::min(at_ + 1, bytes_.size())); }

 private:
  void skip_space() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#')
        at_ = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
      else if (std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0)
        ++at_;
      else
        return;
    }
  }

  std::string_view bytes_;
  std::size_t at_ = 2;  // past the magic number
};

/// A sample of 0 .. maxval on the scale 0 .. 255, rounded to the nearest.
std::uint8_t scaled(std::uint32_t sample, std::uint32_t maxval) {
  return static_cast<std::uint8_t>((std::min(sample, maxval) * 255 + maxval / 2) / maxval);
}

void fill_from_text(Image& image, Tokens& tokens, std::uint32_t maxval) {
  for (std::uint8_t& sample : image.samples) sample = scaled(tokens.number("last pixel"), maxval);
}

void fill_from_binary(Image& image, std::string_view raster, std::uint32_t maxval) {
  const bool wide = maxval > 255;
  for (std::size_t i = 0; i < image.samples.size(); ++i) {
    const auto byte = [&](std::size_t at) {
      return static_cast<std::uint32_t>(static_cast<unsigned char>(raster[at]));
    };
    image.samples[i] = scaled(wide ? byte(2 * i) << 8 | byte(2 * i + 1) : byte(i), maxval);
  }
}

}  // namespace

Image decode_pgm(std::string_view bytes) {
  Tokens tokens(bytes);
  const bool text = bytes.starts_with("P2");
  const std::uint64_t width = tokens.number("width");
  const std::uint64_t height = tokens.number("height");
  const std::uint32_t maxval = tokens.number("greatest value");
  if (maxval == 0 || maxval > 65535)
    throw FileProblem("the PGM image gives {} as its greatest value; 1 to 65535 are allowed", maxval);
  // Before anything is allocated: a pixel takes at least a byte (binary) or a digit and a space (text) of the
  // file.
  const std::uint64_t needed = text ? 2 * width * height - 1 : width * height * (maxval > 255 ? 2 : 1);
  const std::string_view raster = tokens.raster();
  if (width * height > 0 && raster.size() < needed)
    throw FileProblem("the PGM image is cut off: {} x {} pixels need {} bytes, it has {}", width, height,
                      needed, raster.size());
  Image image = make_image(width, height, 1);
  if (text)
    fill_from_text(image, tokens, maxval);
  else
    fill_from_binary(image, raster, maxval);
  return image;
}

std::string encode_pgm(const Image& image) {
  assert(image.channels == 1);
  std::string bytes = fmt::format("P5\n{} {}\n255\n", image.width, image.height);
  bytes.append(image.samples.begin(), image.samples.end());
  return bytes;
}

}  // namespace mstsl::io
