#include "mstsl/io/map_server.hpp"

#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "mutations.hpp"
#include "test_support.hpp"

namespace mstsl::io {
namespace {

namespace fs = std::filesystem;
using test::must;

constexpr const char* kYaml =
    "image: map.pgm\nresolution: 0.05\norigin: [1.5, -2.25, 0.5]\nnegate: 0\noccupied_thresh: "
    "0.65\nfree_thresh: 0.196\n";

/// A folder with a yaml and an image, read as a map.
class Files {
 public:
  Files& yaml(const std::string& text) { return put("map.yaml", text); }
  Files& image(const std::string& bytes) { return put("map.pgm", bytes); }
  Files& put(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
    return *this;
  }
  fs::path path() const { return folder_.path() / "map.yaml"; }
  Result<MapFile> read() const { return read_map_file(path()); }

 private:
  test::TemporaryFolder folder_;
};

std::string error_of(const Files& files) {
  const auto map = files.read();
  return map ? "no error" : map.error().message();
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

OccupancyGrid random_grid(int columns, int rows, Random& random) {
  OccupancyGrid grid({0.1 * random.uniform() + 0.01, columns, rows,
                      Pose2{random.normal(0, 50), random.normal(0, 50), random.uniform(-3, 3)}});
  for (CellState& cell : grid.values()) cell = static_cast<CellState>(random.index(3));
  grid.values().front() = CellState::kFree;
  return grid;
}

TEST(MapServer, ReadsBackExactlyWhatItWrote) {
  Random random(1);
  const test::TemporaryFolder folder;
  for (int round = 0; round < 20; ++round) {
    const OccupancyGrid grid =
        random_grid(1 + static_cast<int>(random.index(30)), 1 + static_cast<int>(random.index(30)), random);
    const fs::path yaml = folder.path() / (round % 2 == 0 ? "a map: #1.yaml" : "true.yml");
    must(write_map(grid, yaml));
    const OccupancyGrid back = must(read_map(yaml));
    EXPECT_EQ(back.geometry(), grid.geometry());
    EXPECT_EQ(back.values(), grid.values());
  }
}

TEST(MapServer, PutsTheTopRowOfTheImageAtTheEndOfTheGrid) {
  Files files;
  files.yaml(kYaml).image("P2\n2 3\n255\n0 254\n205 205\n254 0\n");
  const MapFile map = must(files.read());
  EXPECT_EQ(map.grid.geometry(), (GridGeometry{0.05, 2, 3, {1.5, -2.25, 0.5}}));
  EXPECT_EQ((map.grid[{0, 2}]), CellState::kOccupied);
  EXPECT_EQ((map.grid[{1, 2}]), CellState::kFree);
  EXPECT_EQ((map.grid[{0, 1}]), CellState::kUnknown);
  EXPECT_EQ((map.grid[{0, 0}]), CellState::kFree);
  EXPECT_EQ((map.grid[{1, 0}]), CellState::kOccupied);
}

TEST(MapServer, AgreesWithTheFormulaOfMapServerForEachGrayValue) {
  std::string ramp = "P5 256 1 255\n";
  for (int v = 0; v < 256; ++v) ramp.push_back(static_cast<char>(v));
  for (const bool negate : {false, true}) {
    Files files;
    files.image(ramp).yaml(replaced(kYaml, "negate: 0", negate ? "negate: true" : "negate: false"));
    const MapFile map = must(files.read());
    for (int v = 0; v < 256; ++v) {
      const double occ = negate ? v / 255.0 : (255 - v) / 255.0;
      const CellState expected = occ > 0.65    ? CellState::kOccupied
                                 : occ < 0.196 ? CellState::kFree
                                               : CellState::kUnknown;
      EXPECT_EQ((map.grid[{v, 0}]), expected) << v << (negate ? " negated" : "");
    }
  }
}

TEST(MapServer, ReadsScaleAndRawAsTrinaryAndSaysSo) {
  Files files;
  files.image("P2 4 1 255 0 50 100 255").yaml(std::string(kYaml) + "mode: raw\n");
  const MapFile raw = must(files.read());
  EXPECT_EQ(raw.grid.values(),
            (std::vector{CellState::kFree, CellState::kUnknown, CellState::kOccupied, CellState::kUnknown}));
  ASSERT_EQ(raw.warnings.size(), 1u);
  EXPECT_NE(raw.warnings[0].find("mode raw is read as trinary"), std::string::npos);
  files.image("P2 3 1 255 0 128 255").yaml(std::string(kYaml) + "mode: scale\n");
  const MapFile scale = must(files.read());
  EXPECT_EQ(scale.grid.values(), (std::vector{CellState::kOccupied, CellState::kUnknown, CellState::kFree}));
  EXPECT_EQ(scale.warnings.size(), 1u);
}

TEST(MapServer, FindsTheImageBesideTheYamlOrByItsAbsolutePath) {
  const test::TemporaryFolder elsewhere;
  must(write_file(elsewhere.path() / "far.pgm", "P2 1 1 1 1"));
  Files files;
  files.yaml(replaced(kYaml, "map.pgm", (elsewhere.path() / "far.pgm").string()));
  EXPECT_EQ(must(files.read()).image, elsewhere.path() / "far.pgm");
}

TEST(MapServer, SaysWhatIsWrongWithAYaml) {
  Files files;
  files.image("P2 1 1 255 255");
  const auto error = [&](const std::string& what, const std::string& with) {
    return error_of(files.yaml(replaced(kYaml, what, with)));
  };
  EXPECT_NE(error("image: map.pgm", "image: absent.pgm").find("absent.pgm: No such file"), std::string::npos);
  EXPECT_NE(error("resolution: 0.05\n", "").find("'resolution' is missing"), std::string::npos);
  EXPECT_NE(error("0.05", "wide").find("'resolution' (line 2) is not a number"), std::string::npos);
  EXPECT_NE(error("0.05", "0").find("must be a positive number"), std::string::npos);
  EXPECT_NE(error("0.05", "-0.05").find("must be a positive number"), std::string::npos);
  EXPECT_NE(error("0.05", ".nan").find("not a finite number"), std::string::npos);
  EXPECT_NE(error("0.05", "1e300").find("must be a positive number"), std::string::npos);
  EXPECT_NE(error("[1.5, -2.25, 0.5]", "[1.5, -2.25]").find("three numbers"), std::string::npos);
  EXPECT_NE(error("[1.5, -2.25, 0.5]", "[1.5, .inf, 0]").find("not a finite number"), std::string::npos);
  EXPECT_NE(error("[1.5, -2.25, 0.5]", "here").find("three numbers"), std::string::npos);
  EXPECT_NE(error("negate: 0", "negate: perhaps").find("'negate' (line 4) is not 0 or 1"), std::string::npos);
  EXPECT_NE(error("0.65", "65").find("between 0 and 1"), std::string::npos);
  EXPECT_NE(error("0.196", "0.7").find("above 'occupied_thresh'"), std::string::npos);
  EXPECT_NE(error("negate: 0", "negate: 0\nmode: binary").find("trinary, scale or raw"), std::string::npos);
  EXPECT_NE(error("image: map.pgm", "image: [").find("is not yaml"), std::string::npos);
  EXPECT_NE(error_of(files.yaml("just words")).find("no map_server yaml"), std::string::npos);
  EXPECT_NE(error_of(files.yaml("")).find("no map_server yaml"), std::string::npos);
  const auto nowhere = read_map("/nowhere/map.yaml");
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().message(), "cannot read /nowhere/map.yaml: No such file or directory");
}

TEST(MapServer, RefusesAMapWithoutAFreeCell) {
  Files files;
  files.yaml(kYaml).image("P2 2 1 255 0 205");
  EXPECT_NE(error_of(files).find("the map has no free cell; check 'negate' (0)"), std::string::npos)
      << error_of(files);
}

TEST(MapServer, NamesTheFolderOrEndingItCannotWrite) {
  const OccupancyGrid grid({0.1, 2, 2, {}}, CellState::kFree);
  EXPECT_FALSE(write_map(grid, "/nowhere/at/all/map.yaml"));
  const test::TemporaryFolder folder;
  EXPECT_FALSE(write_map(grid, folder.path() / "map.pgm"));
  EXPECT_FALSE(write_map(OccupancyGrid(), folder.path() / "map.yaml"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(MapServer, AnswersToEveryDamagedYaml) {
  Files files;
  files.image("P2 2 1 255 0 255");
  int good = 0;
  int bad = 0;
  test::for_each_damage(kYaml, 300, Random(2),
                        [&](const std::string& text) { (files.yaml(text).read() ? good : bad) += 1; });
  EXPECT_GT(good, 0);
  EXPECT_GT(bad, 100);
}

TEST(MapServer, ReadsTheRealCorridorLoop) {
  MSTSL_REQUIRE_DATA("maps/corridor-loop/map.yaml");
  const OccupancyGrid grid = must(read_map(test::data_file("maps/corridor-loop/map.yaml")));
  EXPECT_EQ(grid.geometry().resolution_m, 0.05);
  const double free_m2 = static_cast<double>(count(grid, CellState::kFree)) * 0.05 * 0.05;
  EXPECT_GT(free_m2, 200.0);  // corridors of about 2 m around a loop of 61 x 22 m
  EXPECT_LT(free_m2, 61.0 * 22.0);
  EXPECT_GT(count(grid, CellState::kOccupied), 1000u);
}

}  // namespace
}  // namespace mstsl::io
