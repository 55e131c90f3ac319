#include "mstsl/io/estimates.hpp"

#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mstsl/core/random.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "mutations.hpp"
#include "other_programs.hpp"
#include "test_support.hpp"

namespace mstsl::io {
namespace {

namespace fs = std::filesystem;
using test::must;

Estimate sample(Random& random, std::int64_t ns) {
  const auto pose = [&] {
    return Pose2{random.normal(0, 50), random.normal(0, 1e-7), random.uniform(-3, 3)};
  };
  Estimate e;
  e.stamp = {ns};
  e.travelled_m = random.uniform(0, 100);
  e.status = static_cast<LocalizationStatus>(random.index(3));
  if (e.status == LocalizationStatus::kLocalized) e.map_T_base = pose();
  for (double& value : e.covariance.reshaped()) value = random.normal();
  e.probability = random.uniform();
  for (std::size_t i = random.index(5); i > 0; --i) e.hypotheses.push_back({pose(), random.uniform()});
  if (random.chance(0.5)) e.bias_uT = Eigen::Vector3d(random.normal(), random.normal(), 0.0);
  return e;
}

std::vector<Estimate> samples() {
  Random random(1);
  std::vector<Estimate> all;
  for (int i = 0; i < 50; ++i) all.push_back(sample(random, std::int64_t{25'000'000} * i + i));
  return all;
}

const Summary kSummary{{"scans", std::int64_t{50}},
                       {"localized", true},
                       {"cld_m", 3.25},
                       {"method", "two-step"},
                       {"error_m", nullptr}};

fs::path write(const test::TemporaryFolder& folder, const std::vector<Estimate>& estimates) {
  const fs::path file = folder.path() / "estimates.jsonl";
  EstimatesWriter writer = must(EstimatesWriter::open(file));
  for (const Estimate& e : estimates) must(writer.write(e));
  must(writer.close(kSummary));
  return file;
}

void expect_same(const Estimate& a, const Estimate& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(must(to_json_line(a)), must(to_json_line(b)));  // every digit is in the line
}

/// A file with this text, read.
Result<EstimatesFile> read_text(const std::string& text) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "e.jsonl", std::ios::binary) << text;
  return read_estimates(folder.path() / "e.jsonl");
}

std::string error_of(const std::string& text) {
  const auto file = read_text(text);
  return file ? "no error" : file.error().message();
}

const std::string kLine =
    R"({"t": 1.5, "travelled_m": 2, "status": "searching", "pose": null, "covariance": [1,0,0,0,1,0,0,0,1], "probability": 0.5, "hypotheses": [], "bias_uT": null})";

TEST(Estimates, ReadBackExactlyWhatWasWritten) {
  const test::TemporaryFolder folder;
  const std::vector<Estimate> estimates = samples();
  const EstimatesFile back = must(read_estimates(write(folder, estimates)));
  ASSERT_EQ(back.estimates.size(), estimates.size());
  for (std::size_t i = 0; i < estimates.size(); ++i) expect_same(back.estimates[i], estimates[i]);
  EXPECT_EQ(back.summary, kSummary);
}

TEST(Estimates, AreJsonLinesAsTheFormatIsFixed) {
  Estimate e;
  e.stamp = Stamp::from_parts(1'700'000'000, 123'456'789);
  e.status = LocalizationStatus::kLocalized;
  e.map_T_base = Pose2{1.0, -0.0, 0.1};
  e.travelled_m = 1e-7;
  e.covariance << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  e.probability = 1.0 / 3.0;
  e.hypotheses = {{{1, 2, 3}, 0.25}};
  EXPECT_EQ(
      must(to_json_line(e)),
      R"({"t": 1700000000.123456789, "travelled_m": 1e-07, "status": "localized", "pose": {"x": 1, "y": 0, "yaw": 0.1}, )"
      R"("covariance": [1, 2, 3, 4, 5, 6, 7, 8, 9], "probability": 0.3333333333333333, )"
      R"("hypotheses": [{"x": 1, "y": 2, "yaw": 3, "weight": 0.25}], "bias_uT": null})");
}

TEST(Estimates, KeepTheTwentyBestHypothesesOfMore) {
  Estimate e;
  for (int i = 0; i < 30; ++i) e.hypotheses.push_back({{static_cast<double>(i), 0, 0}, 0.01});
  const auto line = nlohmann::json::parse(must(to_json_line(e)));
  ASSERT_EQ(line["hypotheses"].size(), 20u);
  EXPECT_EQ(line["hypotheses"][19]["x"], 19);
}

TEST(Estimates, NeverHoldANumberThatIsNotFinite) {
  const test::TemporaryFolder folder;
  EstimatesWriter writer = must(EstimatesWriter::open(folder.path() / "e.jsonl"));
  Estimate e;
  e.covariance(1, 2) = NAN;
  EXPECT_FALSE(writer.write(e));
  e = Estimate();
  e.map_T_base = Pose2{INFINITY, 0, 0};
  EXPECT_FALSE(writer.write(e));
  must(writer.close({{"mean_error_m", NAN}}));
  EXPECT_EQ(must(read_file(folder.path() / "e.jsonl", 1000)), "{\"summary\":{\"mean_error_m\":null}}\n");
}

TEST(Estimates, SurviveAnInterruptedRun) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "e.jsonl";
  {
    EstimatesWriter writer = must(EstimatesWriter::open(file));
    for (const Estimate& e : samples()) must(writer.write(e));
  }
  const auto absent = read_estimates(file);
  ASSERT_FALSE(absent);
  EXPECT_NE(absent.error().message().find("e.jsonl.part, which can be read"), std::string::npos);
  const EstimatesFile part = must(read_estimates(part_name(file)));
  EXPECT_EQ(part.estimates.size(), samples().size());
  EXPECT_FALSE(part.summary);
  const EstimatesFile cut = must(read_text(kLine + "\n" + kLine + "\n" + kLine.substr(0, 60)));
  EXPECT_EQ(cut.estimates.size(), 2u);
  EXPECT_EQ(must(read_text("")).estimates.size(), 0u);
}

TEST(Estimates, NameTheLineAndTheKeyThatIsWrong) {
  const auto changed = [](const std::string& what, const std::string& with) {
    std::string line = kLine;
    return error_of(kLine + "\n" + line.replace(line.find(what), what.size(), with) + "\n");
  };
  EXPECT_EQ(error_of(kLine + "\n"), "no error");
  EXPECT_NE(changed("\"t\": 1.5, ", "").find("line 2 has no 't'"), std::string::npos);
  EXPECT_NE(changed("1.5", "1e300").find("which is no time"), std::string::npos);
  EXPECT_NE(changed("1.5", "\"now\"").find("'t' that is no finite number"), std::string::npos);
  EXPECT_NE(changed("searching", "sleeping").find("'status'"), std::string::npos);
  EXPECT_NE(changed("\"pose\": null", "\"pose\": {\"x\": 1}").find("has no 'y'"), std::string::npos);
  EXPECT_NE(changed("\"pose\": null", "\"pose\": [1, 2, 3]").find("no object with x, y, yaw"),
            std::string::npos);
  EXPECT_NE(changed("[1,0,0,", "[1,").find("no list of 9 numbers"), std::string::npos);
  EXPECT_NE(changed("0.5", "1.5").find("not between 0 and 1"), std::string::npos);
  EXPECT_NE(changed("\"hypotheses\": []", "\"hypotheses\": [7]").find("'hypotheses'"), std::string::npos);
  EXPECT_NE(changed("null}", "[1, 2]}").find("no list of 3 numbers"), std::string::npos);
  EXPECT_NE(changed("{", "").find("line 2 is no JSON object"), std::string::npos);
  EXPECT_NE(error_of("{\"summary\": {}}\n" + kLine + "\n").find("line 2 comes after the summary"),
            std::string::npos);
  EXPECT_NE(error_of("{\"summary\": 3}\n").find("no object"), std::string::npos);
  EXPECT_NE(error_of("\x1f\x8b\n").find("line 1 is no JSON"), std::string::npos);
}

TEST(Estimates, AnswerToEveryDamage) {
  const test::TemporaryFolder folder;
  const std::string good = must(read_file(write(folder, samples()), 1 << 20)).substr(0, 3000) + "\n" + kLine;
  int bad = 0;
  test::for_each_damage(good, 400, Random(2),
                        [&](const std::string& text) { bad += read_text(text) ? 0 : 1; });
  EXPECT_GT(bad, 100);
  EXPECT_FALSE(read_text(std::string(100'000, '[') + "\n"));
}

TEST(Estimates, LoadInPython) {
  MSTSL_REQUIRE_PROGRAM("command -v python3", "python3");
  const test::TemporaryFolder folder;
  const fs::path file = write(folder, samples());
  const test::Output output = test::run_program(
      "python3 -c \"import json; r = [json.loads(l) for l in open('" + file.string() +
      "')]; print(len(r), r[-1]['summary']['method'], all(len(e['covariance']) == 9 for e in r[:-1]))\"");
  EXPECT_EQ(output.text, "51 two-step True\n");
}

}  // namespace
}  // namespace mstsl::io
