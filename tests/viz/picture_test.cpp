#include "mstsl/viz/picture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <png.h>

#include "mstsl/io/file_bytes.hpp"
#include "mstsl/viz/field_sheet.hpp"

#include "test_support.hpp"

namespace mstsl::viz {
namespace {

namespace fs = std::filesystem;
using std::literals::operator""s;
using test::must;

/// A picture as other programs see it: decoded by libpng.
struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  Eigen::Vector3i at(int x, int y) const {
    const std::size_t i =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
};

Pixels drawn(const Canvas& canvas) {
  const test::TemporaryFolder folder;
  must(canvas.save(folder.path() / "picture.png"));
  const std::string bytes = must(io::read_file(folder.path() / "picture.png", 1 << 24));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  Pixels pixels{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  pixels.rgb.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.rgb.data(), 0, nullptr), 0) << image.message;
  return pixels;
}

/// A hall of 20 x 10 m, walls around it and one pillar at (15, 7), turned by `yaw_rad`.
OccupancyGrid hall(double yaw_rad = 0.0) {
  OccupancyGrid map({0.1, 200, 100, Pose2{0.0, 0.0, yaw_rad}}, CellState::kFree);
  for (std::size_t i = 0; i < map.values().size(); ++i) {
    const Cell c = map.geometry().cell(i);
    const bool wall = c.column == 0 || c.row == 0 || c.column == 199 || c.row == 99;
    const bool pillar = std::abs(c.column - 150) < 6 && std::abs(c.row - 70) < 6;
    if (wall || pillar) map[c] = CellState::kOccupied;
  }
  return map;
}

FieldMap field_over(const OccupancyGrid& map) {
  FieldMap field;
  field.geometry = map.geometry();
  for (std::size_t i = 0; i < field.geometry.size(); ++i) {
    const double x = field.geometry.center_of(field.geometry.cell(i)).x();
    field.mean_uT.emplace_back(static_cast<float>(20.0 + x), 0.0F, 0.0F);
    field.variance_uT2.push_back(Eigen::Vector3f::Ones());
    field.supported.push_back(1);
  }
  return field;
}

/// Where a field's sheet was saved; the file is gone with the test program.
fs::path saved_sheet(const OccupancyGrid& map, const FieldMap& field) {
  static const test::TemporaryFolder folder;
  must(draw_field(map, field, "title", 900.0).save(folder.path() / "sheet.png"));
  return folder.path() / "sheet.png";
}

const Eigen::Vector3i kWall(0x1f, 0x29, 0x33);
const Eigen::Vector3i kAnswer(0xff, 0x4d, 0x2e);

TEST(Picture, PutsMapNorthUpAndEastRight) {
  const Pixels pixels = drawn(draw_run(hall(), {}));
  EXPECT_EQ(pixels.width, 1600);
  // The hall with 2 % of air fills the width between the margins: 20.8 m over 1528 px, the top edge at 36 px.
  const double px_per_m = 1528.0 / 20.8;
  const Eigen::Vector2d pillar(36.0 + (0.4 + 15.05) * px_per_m, 36.0 + (10.0 + 0.4 - 7.05) * px_per_m);
  EXPECT_EQ(pixels.at(static_cast<int>(pillar.x()), static_cast<int>(pillar.y())), kWall);
  const Eigen::Vector2d mirrored(36.0 + (0.4 + 15.05) * px_per_m, 36.0 + (0.4 + 7.05) * px_per_m);
  EXPECT_NE(pixels.at(static_cast<int>(mirrored.x()), static_cast<int>(mirrored.y())), kWall);
}

TEST(Picture, PutsPathsWhereTheMapIs) {
  RunPicture run;
  run.estimated_path = {{15.05, 7.05, 0.0}};  // the answer on top of the pillar
  const Pixels pixels = drawn(draw_run(hall(), run));
  const double px_per_m = 1528.0 / 20.8;
  EXPECT_EQ(
      pixels.at(static_cast<int>(36.0 + 15.45 * px_per_m), static_cast<int>(36.0 + 3.35 * px_per_m) - 9),
      kAnswer);
}

TEST(Picture, KeepsWallsVisibleOnAMapLargerThanTheSheet) {
  OccupancyGrid map({0.05, 4000, 2000, {}}, CellState::kFree);
  for (int row = 0; row < 2000; ++row) map[{2001, row}] = CellState::kOccupied;
  const Pixels pixels = drawn(draw_run(map, {}));
  int darkest = 255;
  for (int x = 700; x < 900; ++x) darkest = std::min(darkest, pixels.at(x, pixels.height / 2).x());
  EXPECT_LT(darkest, 130);  // one cell of 0.4 px: without care it would be a trace of gray
}

TEST(Picture, ColorsTheFieldFromDarkToBright) {
  const OccupancyGrid map = hall();
  const FieldMap field = field_over(map);
  RunPicture run;
  run.field = &field;
  const Pixels pixels = drawn(draw_run(map, run));
  const int y = 400;
  const auto brightness = [&](int x) { return pixels.at(x, y).sum(); };
  EXPECT_LT(brightness(120), brightness(600));
  EXPECT_LT(brightness(600), brightness(1000));
  EXPECT_LT(brightness(1000), brightness(1500));
}

TEST(Picture, GivesTheSameBytesForTheSameRun) {
  const test::TemporaryFolder folder;
  const OccupancyGrid map = hall(0.4);
  const FieldMap field = field_over(map);
  RunPicture run;
  run.title = "title";
  run.field = &field;
  run.hypotheses = {{{3, 3, 1}, 0.7, false}, {{4, 8, 2}, 0.1, true}};
  for (const char* ending : {"png", "svg"}) {
    must(draw_run(map, run).save(folder.path() / ("a."s + ending)));
    must(draw_run(map, run).save(folder.path() / ("b."s + ending)));
  }
  EXPECT_EQ(must(io::read_file(folder.path() / "a.png", 1 << 24)),
            must(io::read_file(folder.path() / "b.png", 1 << 24)));
}

TEST(FieldSheet, ShowsEveryComponentAndWhatWasCovered) {
  const OccupancyGrid map = hall();
  FieldMap field = field_over(map);
  const std::string plain = must(io::read_file(saved_sheet(map, field), 1 << 26));
  EXPECT_EQ(plain, must(io::read_file(saved_sheet(map, field), 1 << 26)));
  // Each change shows: in one component, in the variance, in the coverage, in the lines.
  FieldMap other = field;
  for (Eigen::Vector3f& mean : other.mean_uT) mean.x() *= -1.0F;  // leaves the strength as it is
  EXPECT_NE(must(io::read_file(saved_sheet(map, other), 1 << 26)), plain);
  other = field;
  for (std::size_t i = 0; i < other.variance_uT2.size() / 2; ++i) other.variance_uT2[i] *= 9.0F;
  EXPECT_NE(must(io::read_file(saved_sheet(map, other), 1 << 26)), plain);
  other = field;
  std::fill(other.supported.begin(), other.supported.end(), std::uint8_t{0});
  EXPECT_NE(must(io::read_file(saved_sheet(map, other), 1 << 26)), plain);
  other = field;
  other.fingerprints.push_back({{5.0, 5.0}, {20, 0, -40}, 0.0, 0});
  EXPECT_NE(must(io::read_file(saved_sheet(map, other), 1 << 26)), plain);
}

TEST(FieldSheet, FitsAnyShapeOfMap) {
  for (const auto& [columns, rows] : {std::pair{3, 3}, std::pair{2000, 4}, std::pair{4, 2000}}) {
    const OccupancyGrid map({0.05, columns, rows, {}}, CellState::kFree);
    const Canvas sheet = draw_field(map, field_over(map), "");
    EXPECT_GT(sheet.height(), 100.0);
    EXPECT_LT(sheet.height(), 4000.0);
    EXPECT_EQ(drawn(sheet).width, 2000);
  }
}

TEST(Picture, DrawsWhateverIsThereAndNothingElse) {
  const OccupancyGrid nothing({0.05, 3, 3, {}}, CellState::kUnknown);
  FieldMap empty;
  empty.geometry = nothing.geometry();
  empty.mean_uT.assign(9, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  empty.variance_uT2 = empty.mean_uT;
  empty.supported.assign(9, 0);
  for (const auto quantity : {FieldQuantity::kNorm, FieldQuantity::kX, FieldQuantity::kY, FieldQuantity::kZ,
                              FieldQuantity::kDeviation}) {
    RunPicture run;
    run.field = &empty;
    run.quantity = quantity;
    run.hypotheses = {{{0, 0, 0}, 0.0, false}};
    run.true_path = {{0, 0, 0}};
    EXPECT_GT(drawn(draw_run(nothing, run)).height, 200);
  }
}

TEST(Canvas, SavesPngAndSvgOnly) {
  const test::TemporaryFolder folder;
  Canvas canvas(200, 100);
  canvas.text({10, 20}, "<µT & \"words\">", {});
  must(canvas.save(folder.path() / "a.svg"));
  const std::string svg = must(io::read_file(folder.path() / "a.svg", 1 << 20));
  EXPECT_TRUE(svg.starts_with("<?xml")) << svg.substr(0, 60);
  EXPECT_NE(svg.rfind("</svg>"), std::string::npos);
  const auto gif = canvas.save(folder.path() / "a.gif");
  ASSERT_FALSE(gif);
  EXPECT_NE(gif.error().message().find("must end in .png or .svg"), std::string::npos);
  EXPECT_FALSE(canvas.save(folder.path() / "absent" / "a.png"));
}

TEST(Viridis, GetsBrighterAllTheWay) {
  EXPECT_EQ(to_pixel(viridis(0.0)), 0xff440154U);
  EXPECT_EQ(to_pixel(viridis(1.0)), 0xfffde725U);
  EXPECT_EQ(to_pixel(viridis(NAN)), 0xff440154U);
  EXPECT_EQ(to_pixel(viridis(7.0)), to_pixel(viridis(1.0)));
  double before = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const Color c = viridis(i / 100.0);
    const double luminance =
        0.2126 * std::pow(c.red, 2.2) + 0.7152 * std::pow(c.green, 2.2) + 0.0722 * std::pow(c.blue, 2.2);
    EXPECT_GT(luminance, before) << i;
    before = luminance;
  }
}

}  // namespace
}  // namespace mstsl::viz
