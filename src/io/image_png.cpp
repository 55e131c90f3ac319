#include <csetjmp>
#include <cstring>
#include <memory>

#include <png.h>

#include "file_problem.hpp"
#include "image.hpp"

namespace mstsl::io {
namespace {

/// The bytes yet unread, and what libpng said when it gave up.
struct Source {
  std::string_view rest;
  char problem[200] = "";
};

void read_piece(png_structp png, png_bytep out, png_size_t count) {
  Source& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (source.rest.size() < count) png_error(png, "the file is cut off");
  std::memcpy(out, source.rest.data(), count);
  source.rest.remove_prefix(count);
}

[[noreturn]] void give_up(png_structp png, png_const_charp message) {
  Source& source = *static_cast<Source*>(png_get_error_ptr(png));
  std::strncpy(source.problem, message, sizeof source.problem - 1);
  png_longjmp(png, 1);
}

void pass_over(png_structp, png_const_charp) {}

/// libpng's two structures, released together.
struct Decoder {
  png_structp png;
  png_infop info;

  explicit Decoder(Source& source)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, give_up, pass_over)),
        info(png != nullptr ? png_create_info_struct(png) : nullptr) {
    if (info == nullptr) throw std::bad_alloc();
    png_set_read_fn(png, &source, read_piece);
    png_set_user_limits(png, static_cast<png_uint_32>(kMaxPixels), static_cast<png_uint_32>(kMaxPixels));
    png_set_chunk_malloc_max(png, 1 << 20);
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { png_destroy_read_struct(&png, info != nullptr ? &info : nullptr, nullptr); }
};

// libpng leaves a failure by longjmp, which must pass over no C++ object with a destructor: so these two
// functions have none, and answer whether they came to their end.

/// Reads the header and asks for 8-bit gray, RGB, gray + alpha or RGBA, without any gamma correction.
bool read_header(const Decoder& decoder) {
  if (setjmp(png_jmpbuf(decoder.png)) != 0) return false;
  png_read_info(decoder.png, decoder.info);
  png_set_expand(decoder.png);  // palettes, 1-4 bit gray, transparent colours
  png_set_scale_16(decoder.png);
  png_set_interlace_handling(decoder.png);
  png_read_update_info(decoder.png, decoder.info);
  return true;
}

bool read_pixels(const Decoder& decoder, png_bytepp rows) {
  if (setjmp(png_jmpbuf(decoder.png)) != 0) return false;
  png_read_image(decoder.png, rows);
  png_read_end(decoder.png, nullptr);
  return true;
}

/// Before memory is taken: deflate shortens by no more than 1032 to 1, so a small file cannot hold a huge
/// image.
void expect_room_for_pixels(const Decoder& decoder, std::size_t file_bytes) {
  constexpr std::uint64_t kMostDeflate = 1032;
  const std::uint64_t bits = std::uint64_t{png_get_image_width(decoder.png, decoder.info)} *
                             png_get_image_height(decoder.png, decoder.info) *
                             png_get_bit_depth(decoder.png, decoder.info);
  if (bits / 8 > file_bytes * kMostDeflate)
    throw FileProblem("the PNG image is cut off: {} bytes cannot hold its {} x {} pixels", file_bytes,
                      png_get_image_width(decoder.png, decoder.info),
                      png_get_image_height(decoder.png, decoder.info));
}

/// Gray + alpha as RGB + alpha, because map_server averages alpha as one of four.
Image with_gray_spread(const Image& gray_alpha) {
  Image image = make_image(static_cast<std::uint64_t>(gray_alpha.width),
                           static_cast<std::uint64_t>(gray_alpha.height), 4);
  for (std::size_t i = 0; i < gray_alpha.samples.size() / 2; ++i) {
    for (std::size_t k = 0; k < 3; ++k) image.samples[4 * i + k] = gray_alpha.samples[2 * i];
    image.samples[4 * i + 3] = gray_alpha.samples[2 * i + 1];
  }
  return image;
}

}  // namespace

Image decode_png(std::string_view bytes) {
  Source source{bytes};
  const Decoder decoder(source);
  if (!read_header(decoder)) throw FileProblem("the PNG image is damaged: {}", source.problem);
  expect_room_for_pixels(decoder, bytes.size());
  Image image = make_image(png_get_image_width(decoder.png, decoder.info),
                           png_get_image_height(decoder.png, decoder.info),
                           png_get_channels(decoder.png, decoder.info));
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.height));
  const std::size_t stride = image.samples.size() / rows.size();
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = image.samples.data() + i * stride;
  if (!read_pixels(decoder, rows.data())) throw FileProblem("the PNG image is damaged: {}", source.problem);
  return image.channels == 2 ? with_gray_spread(image) : image;
}

}  // namespace mstsl::io
