#include "image.hpp"

#include "file_problem.hpp"

namespace mstsl::io {

Image make_image(std::uint64_t width, std::uint64_t height, int channels) {
  if (width == 0 || height == 0) throw FileProblem("the image has no pixels ({} x {})", width, height);
  if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels)
    throw FileProblem("the image claims {} x {} pixels, more than the {} that a map may have", width, height,
                      kMaxPixels);
  Image image{static_cast<int>(width), static_cast<int>(height), channels, {}};
  image.samples.resize(width * height * static_cast<std::size_t>(channels));
  return image;
}

Image decode_image(std::string_view bytes) {
  if (bytes.starts_with("P2") || bytes.starts_with("P5")) return decode_pgm(bytes);
  if (bytes.starts_with("\x89PNG")) return decode_png(bytes);
  if (bytes.starts_with("BM")) return decode_bmp(bytes);
  throw FileProblem("this is no PGM (P2, P5), PNG or BMP image; convert it to one of them");
}

}  // namespace mstsl::io
