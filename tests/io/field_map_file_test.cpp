#include "mstsl/io/field_map_file.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "mstsl/core/random.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "mutations.hpp"
#include "other_programs.hpp"
#include "test_support.hpp"

namespace mstsl::io {
namespace {

namespace fs = std::filesystem;
using test::must;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Eigen::Vector3f noise(Random& random, double mean, double sd) {
  return Eigen::Vector3d(random.normal(mean, sd), random.normal(mean, sd), random.normal(mean, sd))
      .cast<float>();
}

/// A map with every kind of content: empty, supported and unsupported cells, fingerprints, all attributes.
FieldMap sample_map(Random random, double yaw_rad = 0.0) {
  FieldMap map;
  map.geometry = {0.05, 31, 17, Pose2{-12.3456789, 7.1, yaw_rad}};
  for (std::size_t i = 0; i < map.geometry.size(); ++i) {
    const bool empty = random.chance(0.3);
    map.mean_uT.push_back(empty ? Eigen::Vector3f::Constant(kNaN) : noise(random, 20, 8));
    map.variance_uT2.push_back(empty ? Eigen::Vector3f::Constant(kNaN)
                                     : noise(random, 0, 2).cwiseAbs().eval());
    map.supported.push_back(!empty && random.chance(0.8) ? 1 : 0);
  }
  map.model = FieldModel::kGpr;
  map.height_m = 0.35;
  map.hyperparameters = {{"length_scale_x_m", 0.1 + 1e-17}, {"noise_x_uT", 1.0 / 3.0}};
  map.provenance = {"survey_1.mcap", "--model gpr, \"quoted\" µT\nsecond line"};
  for (int i = 0; i < 40; ++i)
    map.fingerprints.push_back(
        {{random.normal(0, 30), random.normal(0, 30)}, noise(random, 0, 40).cast<double>() / 3.0});
  return map;
}

/// A map that knows its drives, and has been updated.
FieldMap updated_map(Random random) {
  FieldMap map = sample_map(random);
  map.drives = {{"survey_1.mcap", Stamp{-5}, Stamp{7}},
                {"monday µ.bag", Stamp{1'700'000'000'123'456'789}, Stamp{1'700'000'001'000'000'000}}};
  for (std::size_t i = 0; i < map.geometry.size(); ++i)
    map.newest_drive.push_back(map.supported[i] == 0 ? -1 : random.chance(0.5) ? 1 : 0);
  for (Fingerprint& f : map.fingerprints) {
    f.heading_rad = random.normal();
    f.session = random.chance(0.5) ? 1 : 0;
  }
  for (int i = 0; i < 5; ++i) map.replaced.push_back({map.fingerprints[static_cast<std::size_t>(i)], 1});
  return map;
}

/// The very bits, so that NaN equals NaN.
template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same(const FieldMap& a, const FieldMap& b) {
  EXPECT_EQ(a.geometry, b.geometry);
  EXPECT_TRUE(same_bits(a.mean_uT, b.mean_uT));
  EXPECT_TRUE(same_bits(a.variance_uT2, b.variance_uT2));
  EXPECT_EQ(a.supported, b.supported);
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(a.height_m, b.height_m);
  EXPECT_EQ(a.hyperparameters, b.hyperparameters);
  EXPECT_EQ(a.provenance, b.provenance);
  ASSERT_EQ(a.fingerprints.size(), b.fingerprints.size());
  for (std::size_t i = 0; i < a.fingerprints.size(); ++i) {
    EXPECT_EQ(a.fingerprints[i].position_m, b.fingerprints[i].position_m);
    EXPECT_EQ(a.fingerprints[i].field_uT, b.fingerprints[i].field_uT);
    EXPECT_EQ(a.fingerprints[i].heading_rad, b.fingerprints[i].heading_rad);
    EXPECT_EQ(a.fingerprints[i].session, b.fingerprints[i].session);
  }
  EXPECT_EQ(a.drives, b.drives);
  EXPECT_EQ(a.newest_drive, b.newest_drive);
  ASSERT_EQ(a.replaced.size(), b.replaced.size());
  for (std::size_t i = 0; i < a.replaced.size(); ++i) {
    EXPECT_EQ(a.replaced[i].by_session, b.replaced[i].by_session);
    EXPECT_EQ(a.replaced[i].fingerprint.position_m, b.replaced[i].fingerprint.position_m);
    EXPECT_EQ(a.replaced[i].fingerprint.session, b.replaced[i].fingerprint.session);
  }
}

FieldMap through_memory(const FieldMap& map) {
  return must(decode_field_map(must(encode_field_map(map, "m")), "m"));
}

std::string error_of(const std::string& bytes) {
  const auto map = decode_field_map(bytes, "field.nc");
  return map ? "no error" : map.error().message();
}

TEST(FieldMapFile, ReadsBackEveryBitItWrote) {
  const test::TemporaryFolder folder;
  for (const double yaw_rad : {0.0, 0.7, -3.0}) {
    const FieldMap map = sample_map(Random(1), yaw_rad);
    must(write_field_map(map, folder.path() / "field.nc"));
    expect_same(map, must(read_field_map(folder.path() / "field.nc")));
  }
  for (const FieldModel model : {FieldModel::kBilinear, FieldModel::kFingerprint}) {
    FieldMap map = sample_map(Random(2));
    map.model = model;
    map.fingerprints.clear();
    map.provenance = {"one log"};
    map.hyperparameters.clear();
    expect_same(map, through_memory(map));
    map.provenance.clear();
    expect_same(map, through_memory(map));
  }
}

TEST(FieldMapFile, KeepsItsDrivesAndWhatTheyReplaced) {
  const FieldMap map = updated_map(Random(8));
  expect_same(map, through_memory(map));
  FieldMap fresh = updated_map(Random(9));
  fresh.replaced.clear();
  expect_same(fresh, through_memory(fresh));
}

TEST(FieldMapFile, GivesTheSameBytesForTheSameMap) {
  EXPECT_EQ(must(encode_field_map(sample_map(Random(3)), "a")),
            must(encode_field_map(sample_map(Random(3)), "b")));
  EXPECT_NE(must(encode_field_map(sample_map(Random(3)), "a")),
            must(encode_field_map(sample_map(Random(4)), "a")));
}

TEST(FieldMapFile, MayBeReadFromManyThreadsAtOnce) {
  const FieldMap map = sample_map(Random(5));
  const std::string bytes = must(encode_field_map(map, "m"));
  std::vector<std::thread> threads;
  std::vector<FieldMap> read(8);
  for (std::size_t i = 0; i < read.size(); ++i)
    threads.emplace_back([&, i] { read[i] = must(decode_field_map(bytes, "m")); });
  for (std::thread& thread : threads) thread.join();
  for (const FieldMap& one : read) expect_same(map, one);
}

TEST(FieldMapFile, RefusesToWriteWhatCouldNotBeRead) {
  const auto refusal = [](const std::function<void(FieldMap&)>& spoil) {
    FieldMap map = updated_map(Random(6));
    map.mean_uT[0] = map.variance_uT2[0] = Eigen::Vector3f::Ones();
    spoil(map);
    const test::TemporaryFolder folder;
    const auto written = write_field_map(map, folder.path() / "field.nc");
    EXPECT_TRUE(fs::is_empty(folder.path()));
    return written ? "no error" : written.error().message();
  };
  EXPECT_NE(refusal([](FieldMap& m) { m.mean_uT.pop_back(); }).find("do not fit"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.mean_uT[0].y() = kNaN; }).find("lacks some"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.mean_uT[0].y() = INFINITY; }).find("lacks some"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.variance_uT2[0].z() = -1; }).find("negative variance"),
            std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.supported[0] = 2; }).find("must be 0 or 1"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.geometry.resolution_m = 0; }).find("resolution"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.hyperparameters["a b/c"] = 1; }).find("'a b/c'"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.hyperparameters["a"] = NAN; }).find("'a'"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.fingerprints[3].session = 2; }).find("fingerprint 3 is of drive 2"),
            std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.newest_drive[2] = 2; }).find("'newest_drive' is 2"),
            std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.newest_drive.pop_back(); }).find("does not fit"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.replaced[1].by_session = -1; }).find("replaced fingerprint 1"),
            std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.drives[1].last = Stamp{0}; }).find("ends before"), std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m.fingerprints[3].field_uT.x() = NAN; }).find("fingerprint 3"),
            std::string::npos);
  EXPECT_NE(refusal([](FieldMap& m) { m = FieldMap(); }).find("no cells"), std::string::npos);
}

TEST(FieldMapFile, TellsWhatIsNoFieldMapWithoutNoiseOnStderr) {
  testing::internal::CaptureStderr();
  EXPECT_NE(error_of("").find("no NetCDF file"), std::string::npos) << error_of("");
  EXPECT_NE(error_of(std::string(5000, 'x')).find("no NetCDF file"), std::string::npos);
  const std::string good = must(encode_field_map(sample_map(Random(7)), "m"));
  EXPECT_NE(error_of(good.substr(0, 3000)).find("damaged or cut off"), std::string::npos)
      << error_of(good.substr(0, 3000));
  std::thread([&] { EXPECT_NE(error_of(good.substr(0, 3000)), "no error"); }).join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  const auto absent = read_field_map("/nowhere/field.nc");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().message(), "cannot read /nowhere/field.nc: No such file or directory");
}

TEST(FieldMapFile, NoticesEveryDamage) {
  const std::string good = must(encode_field_map(updated_map(Random(8)), "m"));
  const std::size_t seal_at = good.rfind("\nmstsl crc32 ");
  const std::string seal = good.substr(seal_at);
  test::for_each_damage(good.substr(0, seal_at), 1000, Random(9), [&](const std::string& bytes) {
    const auto map = decode_field_map(bytes + seal, "m");
    ASSERT_TRUE(!map || bytes + seal == good);
  });
}

TEST(FieldMapFile, AnswersToEveryLength) {
  const std::string good = must(encode_field_map(updated_map(Random(8)), "m"));
  for (std::size_t length = 0; length < good.size(); length += 101)
    if (const auto map = decode_field_map(good.substr(0, length), "m"); map)
      expect_same(*map, updated_map(Random(8)));
  EXPECT_FALSE(decode_field_map(good.substr(0, good.size() / 2), "m"));
}

/// A folder with field.nc in it, for programs of others.
class Opened {
 public:
  Opened() { must(write_field_map(updated_map(Random(10)), file())); }
  fs::path file() const { return folder_.path() / "field.nc"; }
  test::Output python(const std::string& script) const {
    must(write_file(folder_.path() / "script.py",
                    "import netCDF4\nd = netCDF4.Dataset('field.nc', 'r+')\n" + script));
    return test::run_program("cd '" + folder_.path().string() + "' && /usr/bin/python3 script.py");
  }

 private:
  test::TemporaryFolder folder_;
};

TEST(FieldMapFile, OpensInNcdump) {
  MSTSL_REQUIRE_PROGRAM("command -v ncdump", "netcdf-bin");
  const Opened opened;
  const test::Output header = test::run_program("ncdump -h '" + opened.file().string() + "'");
  EXPECT_EQ(header.status, 0);
  for (const char* line :
       {"float bx(y, x)", "bx:units = \"uT\"", "bx:_FillValue = NaNf", "float bz_variance(y, x)",
        "byte supported(y, x)", "supported:flag_meanings = \"unsupported supported\"", "double x(x)",
        "x:units = \"m\"", "double fp_bx(fingerprint)", ":Conventions = \"CF-1.8\"", ":model = \"gpr\"",
        ":hyperparameter_noise_x_uT = 0.3333", ":provenance"})
    EXPECT_NE(header.text.find(line), std::string::npos) << line << " in\n" << header.text;
}

TEST(FieldMapFile, OpensInPythonWithTheSameNumbers) {
  MSTSL_REQUIRE_PROGRAM("/usr/bin/python3 -c 'import netCDF4'", "python3-netcdf4");
  const Opened opened;
  const FieldMap map = updated_map(Random(10));
  const test::Output output = opened.python(
      "b = d['by'][:]\nprint(d.Conventions, d['by'].units, b.shape, int(b.mask.sum() if b.mask.shape else 0) "
      "+ "
      "int((b.filled(float('nan')) != b.filled(float('nan'))).sum()) > 0)\n"
      "print(repr(float(d['fp_bz'][7])), repr(float(d['x'][0])), repr(float(d['y'][16])), "
      "d.hyperparameter_length_scale_x_m)\n");
  EXPECT_EQ(output.status, 0);
  char numbers[200];
  std::snprintf(numbers, sizeof numbers, "%.17g", map.fingerprints[7].field_uT.z());
  EXPECT_NE(output.text.find("CF-1.8 uT (17, 31) True"), std::string::npos) << output.text;
  double fp_bz = 0.0;
  double x = 0.0;
  double y = 0.0;
  double length = 0.0;
  ASSERT_EQ(
      std::sscanf(output.text.c_str() + output.text.find('\n'), "%lf %lf %lf %lf", &fp_bz, &x, &y, &length),
      4)
      << output.text;
  EXPECT_EQ(fp_bz, map.fingerprints[7].field_uT.z());
  EXPECT_NEAR(x, map.geometry.center_of({0, 0}).x(), 1e-12);
  EXPECT_NEAR(y, map.geometry.center_of({0, 16}).y(), 1e-12);
  EXPECT_EQ(length, map.hyperparameters.at("length_scale_x_m"));
}

/// A change that python makes to a good file, and what the reader must say of it ("" for nothing).
struct Change {
  const char* python;
  const char* complaint;
};
const std::vector<Change> kChanges{
    {"pass", ""},
    {"d['bx'].units = 'T'", "'bx' is in 'T'; uT are needed"},
    {"d['bx'].delncattr('units')", "'bx' has no units"},
    {"d.renameVariable('by', 'b2')", "'by' is missing"},
    {"d.renameDimension('x', 'lon')", "no dimensions x and y"},
    {"d.model = 'kriging'", "'kriging'"},
    {"d.delncattr('resolution_m')", "'resolution_m' is missing"},
    {"d.resolution_m = 0.1", "contradicts"},
    {"d.resolution_m = 'fine'", "no number"},
    {"d['bx'][3, 4] = float('inf')", "column 4, row 3"},
    {"d.renameVariable('supported', 's'); d.createVariable('supported', 'f4', ('y', 'x'))",
     "not of type byte"},
    {"d.renameVariable('bz', 's'); d.createVariable('bz', 'f4', ('x', 'y')).units = 'uT'",
     "dimensions (y, x)"},
    {"d.close(); d = netCDF4.Dataset(name, 'w'); d.createDimension('x', 2000000000); d.createDimension('y', "
     "2000000000); "
     "d.setncatts(dict(model='gpr', resolution_m=0.05, grid_origin_x_m=0.0, grid_origin_y_m=0.0, "
     "grid_yaw_rad=0.0))",
     "more than the 100000000"},
    {"d.close(); d = netCDF4.Dataset(name, 'w', format='NETCDF3_CLASSIC')", "'model' is missing"}};

TEST(FieldMapFile, NamesWhatPythonMadeWrong) {
  MSTSL_REQUIRE_PROGRAM("/usr/bin/python3 -c 'import netCDF4'", "python3-netcdf4");
  const Opened opened;
  std::string script = "import shutil\nd.close()\n";
  for (std::size_t i = 0; i < kChanges.size(); ++i) {
    const std::string name = std::to_string(i) + ".nc";
    script += "name = '" + name + "'\nshutil.copy('field.nc', name)\nd = netCDF4.Dataset(name, 'r+')\n" +
              kChanges[i].python + "\nd.close()\n";
  }
  const test::Output output = opened.python(script);
  ASSERT_EQ(output.status, 0) << output.text;
  for (std::size_t i = 0; i < kChanges.size(); ++i) {
    const auto map = read_field_map(opened.file().parent_path() / (std::to_string(i) + ".nc"));
    const std::string said = map ? "" : map.error().message();
    EXPECT_EQ(map.ok(), *kChanges[i].complaint == '\0') << said;
    EXPECT_NE(said.find(kChanges[i].complaint), std::string::npos) << kChanges[i].python << ": " << said;
  }
}

}  // namespace
}  // namespace mstsl::io
