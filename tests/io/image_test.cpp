#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include "mstsl/core/random.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"
#include "mstsl/io/map_server.hpp"

#include "mutations.hpp"
#include "other_programs.hpp"
#include "test_support.hpp"

/// Images as maps, through the public reader: what a pixel means is what counts.
namespace mstsl::io {
namespace {

namespace fs = std::filesystem;
using test::must;
using enum CellState;

/// Reads image bytes as a map with thresholds 0.65 and 0.196.
Result<OccupancyGrid> map_of(const std::string& image, const std::string& more_yaml = "") {
  static const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "image", std::ios::binary) << image;
  std::ofstream(folder.path() / "map.yaml") << "image: image\nresolution: 1\norigin: [0, 0, 0]\nnegate: "
                                               "0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
                                            << more_yaml;
  return read_map(folder.path() / "map.yaml");
}

std::vector<CellState> cells(const std::string& image, const std::string& more_yaml = "") {
  return must(map_of(image, more_yaml)).values();
}

std::string error_of(const std::string& image) {
  const auto map = map_of(image);
  return map ? "no error" : map.error().message();
}

std::string bytes_of(const std::vector<int>& values) { return {values.begin(), values.end()}; }

std::string little_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text.push_back(static_cast<char>(value >> (8 * i)));
  return text;
}

std::string png(int width, int height, int format, const std::string& samples) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = static_cast<png_uint_32>(format);
  std::string bytes(1 << 16, '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, samples.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
  bytes.resize(size);
  return bytes;
}

/// A BMP with a BITMAPINFOHEADER. A negative height means top-down rows.
std::string bmp(int width, int height, int bits, const std::string& palette, const std::string& rows,
                std::uint32_t compression = 0) {
  const auto pixels_at = static_cast<std::uint32_t>(54 + palette.size());
  return "BM" + little_endian(pixels_at + static_cast<std::uint32_t>(rows.size()), 4) + little_endian(0, 4) +
         little_endian(pixels_at, 4) + little_endian(40, 4) +
         little_endian(static_cast<std::uint32_t>(width), 4) +
         little_endian(static_cast<std::uint32_t>(height), 4) + little_endian(1, 2) +
         little_endian(static_cast<std::uint32_t>(bits), 2) + little_endian(compression, 4) +
         little_endian(0, 4) + little_endian(2835, 4) + little_endian(2835, 4) +
         little_endian(compression == 3 ? 0 : static_cast<std::uint32_t>(palette.size() / 4), 4) +
         little_endian(0, 4) + palette + rows;
}

const std::string kBlackAndWhite = bytes_of({0, 0, 0, 0, 255, 255, 255, 0});

TEST(Pgm, ReadsTextAndBinaryWithCommentsAndAnyMaxval) {
  const std::vector<CellState> expected{kOccupied, kUnknown, kFree};
  EXPECT_EQ(cells("P2\n# a comment\n3 # width\n1\n255\n0 128 255\n"), expected);
  EXPECT_EQ(cells("P2 3 1 15 0 8 15"), expected);
  EXPECT_EQ(cells("P5\n# CREATOR: map_saver\n3 1\n255\n" + bytes_of({0, 128, 255})), expected);
  EXPECT_EQ(cells("P5 3 1 100\n" + bytes_of({0, 50, 100})), expected);
  EXPECT_EQ(cells("P5 3 1 65535\n" + bytes_of({0, 0, 128, 0, 255, 255})), expected);
}

TEST(Pgm, TellsWhatIsMissing) {
  EXPECT_NE(error_of("P5 10 10 255\nxx").find("cut off: 10 x 10 pixels need 100 bytes, it has 2"),
            std::string::npos);
  EXPECT_NE(error_of("P2 3 1 255 0 9").find("cut off"), std::string::npos);
  EXPECT_NE(error_of("P2 3 1 255 0 x 255").find("no number"), std::string::npos);
  EXPECT_NE(error_of("P5 3").find("cut off before its height"), std::string::npos);
  EXPECT_NE(error_of("P5 0 4 255\n").find("no pixels"), std::string::npos);
  EXPECT_NE(error_of("P5 3 1 0\nabc").find("greatest value"), std::string::npos);
  EXPECT_NE(error_of("P5 999999999 999999999 255\nabc").find("cut off"), std::string::npos);
  EXPECT_NE(error_of("P5 -3 1 255\nabc").find("no number"), std::string::npos);
  EXPECT_NE(error_of("GIF89a").find("no PGM (P2, P5), PNG or BMP"), std::string::npos);
  EXPECT_NE(error_of("").find("no PGM"), std::string::npos);
}

TEST(Png, AveragesOverTheChannelsAsMapServerDoes) {
  EXPECT_EQ(cells(png(3, 1, PNG_FORMAT_GRAY, bytes_of({0, 128, 255}))),
            (std::vector{kOccupied, kUnknown, kFree}));
  EXPECT_EQ(cells(png(3, 1, PNG_FORMAT_RGB, bytes_of({255, 0, 0, 255, 255, 255, 0, 0, 255}))),
            (std::vector{kOccupied, kFree, kOccupied}));
}

TEST(Png, CountsAlphaAsAChannelInTrinaryAndAsUnknownInScale) {
  // White opaque, black opaque, white transparent, black transparent: means 255, 63.75, 191.25, 0.
  const std::string image =
      png(4, 1, PNG_FORMAT_RGBA, bytes_of({255, 255, 255, 255, 0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 0, 0}));
  EXPECT_EQ(cells(image), (std::vector{kFree, kOccupied, kUnknown, kOccupied}));
  EXPECT_EQ(cells(image, "mode: scale\n"), (std::vector{kFree, kOccupied, kUnknown, kUnknown}));
  const std::string gray = png(3, 1, PNG_FORMAT_GA, bytes_of({255, 255, 0, 255, 255, 0}));
  EXPECT_EQ(cells(gray), (std::vector{kFree, kOccupied, kUnknown}));
}

TEST(Png, TellsOfDamage) {
  const std::string good = png(40, 40, PNG_FORMAT_GRAY, std::string(1600, '\xfe'));
  EXPECT_NE(error_of(good.substr(0, good.size() / 2)).find("PNG image is damaged"), std::string::npos);
  std::string huge = good;
  huge.replace(16, 8, bytes_of({0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff}));
  EXPECT_NE(error_of(huge).find("PNG image is damaged"), std::string::npos) << error_of(huge);
}

TEST(Bmp, ReadsEveryDepthBottomUpAndTopDown) {
  const std::vector<CellState> expected{kFree, kOccupied, kFree, kFree};  // row 0 is the lower one
  EXPECT_EQ(cells(bmp(2, 2, 1, kBlackAndWhite, bytes_of({0x80, 0, 0, 0, 0xc0, 0, 0, 0}))), expected);
  EXPECT_EQ(cells(bmp(2, -2, 1, kBlackAndWhite, bytes_of({0xc0, 0, 0, 0, 0x80, 0, 0, 0}))), expected);
  EXPECT_EQ(cells(bmp(2, 2, 4, kBlackAndWhite, bytes_of({0x10, 0, 0, 0, 0x11, 0, 0, 0}))), expected);
  EXPECT_EQ(cells(bmp(2, 2, 8, kBlackAndWhite, bytes_of({1, 0, 9, 9, 1, 1, 9, 9}))), expected);
  const std::string white3(3, '\xff');
  const std::string black3(3, '\0');
  EXPECT_EQ(cells(bmp(2, 2, 24, "", white3 + black3 + "xx" + white3 + white3 + "xx")), expected);
  const std::string white4 = white3 + std::string(1, '\0');
  const std::string black4 = black3 + std::string(1, '\0');
  EXPECT_EQ(cells(bmp(2, -2, 32, "", white4 + white4 + white4 + black4)), expected);
  const std::string masks =
      little_endian(0xff000000, 4) + little_endian(0xff0000, 4) + little_endian(0xff00, 4);
  const std::string xbgr_white = std::string(1, '\0') + white3;
  EXPECT_EQ(cells(bmp(2, -2, 32, masks, xbgr_white + xbgr_white + xbgr_white + std::string(4, '\0'), 3)),
            expected);
}

TEST(Bmp, TellsWhatItCannotRead) {
  EXPECT_NE(error_of(bmp(2, 2, 8, kBlackAndWhite, "abc")).find("cut off"), std::string::npos);
  EXPECT_NE(
      error_of(bmp(2, 2, 8, kBlackAndWhite, std::string(8, '\x05'))).find("colour 5 of a palette that has 2"),
      std::string::npos);
  EXPECT_NE(error_of(bmp(2, 2, 16, "", std::string(8, 'a'))).find("16 bits a pixel"), std::string::npos);
  EXPECT_NE(error_of(bmp(2, 2, 8, kBlackAndWhite, std::string(8, '\1'), 1)).find("compression 1"),
            std::string::npos);
  EXPECT_NE(error_of(bmp(2'000'000'000, 2'000'000'000, 32, "", "abc")).find("cut off"), std::string::npos);
  EXPECT_NE(error_of(bmp(2, INT32_MIN, 8, kBlackAndWhite, "abc")).find("cut off"), std::string::npos);
  EXPECT_NE(error_of("BM").find("cut off"), std::string::npos);
}

TEST(Images, AnswerToEveryDamage) {
  Random random(3);
  std::string noise;
  for (int i = 0; i < 300; ++i) noise.push_back(static_cast<char>(random.index(256)));
  const std::string palette = [] {
    std::string colors;
    for (int i = 0; i < 256; ++i) colors += bytes_of({i, i, i, 0});
    return colors;
  }();
  int bad = 0;
  for (const std::string& good : {"P5 20 15 255\n" + noise, std::string("P2 # c\n3 2 100 0 20 30 80 90 100"),
                                  png(10, 10, PNG_FORMAT_RGB, noise), png(15, 10, PNG_FORMAT_GA, noise),
                                  bmp(20, 15, 8, palette, noise), bmp(10, 10, 24, "", noise + noise)})
    test::for_each_damage(good, 150, random.fork(7),
                          [&](const std::string& image) { bad += map_of(image) ? 0 : 1; });
  EXPECT_GT(bad, 100);
}

/// Python's imaging library writes the same picture in many ways; all must be the same map.
TEST(Images, WrittenByPillowAreReadAlike) {
  MSTSL_REQUIRE_PROGRAM("/usr/bin/python3 -c 'import PIL'", "python3-pil");
  const test::TemporaryFolder folder;
  const std::string script = R"(
import sys
from PIL import Image
gray = Image.new('L', (37, 23))
gray.putdata([(0, 205, 254)[(x * x + 3 * y * y + x * y) % 7 % 3] for y in range(23) for x in range(37)])
gray.save('gray.pgm'); gray.save('gray.png'); gray.save('gray.bmp')
gray.convert('RGB').save('rgb.png'); gray.convert('RGB').save('rgb.bmp')
gray.convert('P').save('palette.png'); gray.convert('P').save('palette.bmp')
gray.quantize(3).save('few.png')
gray.save('interlaced.png', interlace=1)
gray.convert('RGBA').save('rgba.bmp')
)";
  must(write_file(folder.path() / "make.py", script));
  const test::Output made =
      test::run_program("cd '" + folder.path().string() + "' && /usr/bin/python3 make.py");
  ASSERT_EQ(made.status, 0) << made.text;
  const auto read = [&](const char* name) { return cells(must(read_file(folder.path() / name, 1 << 20))); };
  const std::vector<CellState> expected = read("gray.pgm");
  for (int row = 0; row < 23; ++row)
    for (int x = 0; x < 37; ++x) {
      const int y = 22 - row;
      const CellState state = std::vector{
          kOccupied, kUnknown, kFree}[static_cast<std::size_t>((x * x + 3 * y * y + x * y) % 7 % 3)];
      ASSERT_EQ(expected[static_cast<std::size_t>(row * 37 + x)], state) << x << " " << y;
    }
  for (const char* name : {"gray.png", "gray.bmp", "rgb.png", "rgb.bmp", "palette.png", "palette.bmp",
                           "few.png", "interlaced.png"})
    EXPECT_EQ(read(name), expected) << name;
}

}  // namespace
}  // namespace mstsl::io
