#include "report_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "mstsl/magnetic/survey_coverage.hpp"

namespace mstsl::app {
namespace {

/// What one drive has to do with a map.
struct Share {
  std::size_t fingerprints = 0, replaced = 0;
  double newest_m2 = 0.0;  ///< ground that no later drive came near
};

std::vector<Share> shares(const FieldMap& map) {
  std::vector<Share> shares(map.drives.size());
  for (const Fingerprint& f : map.fingerprints) ++shares[static_cast<std::size_t>(f.session)].fingerprints;
  for (const ReplacedFingerprint& r : map.replaced)
    ++shares[static_cast<std::size_t>(r.fingerprint.session)].replaced;
  const double cell_m2 = std::pow(map.geometry.resolution_m, 2);
  for (const std::int32_t drive : map.newest_drive)
    if (drive >= 0) shares[static_cast<std::size_t>(drive)].newest_m2 += cell_m2;
  return shares;
}

}  // namespace

std::string three(const Eigen::Array3d& v, const char* unit) {
  return fmt::format("{:.2f} {:.2f} {:.2f}{}", v(0), v(1), v(2), unit);
}

std::array<double, 3> list(const Eigen::Array3d& v) { return {v(0), v(1), v(2)}; }

std::string date(Stamp stamp) {
  constexpr double kYear2000_s = 946684800.0, kYear2200_s = 7258118400.0;
  if (stamp.seconds() < kYear2000_s || stamp.seconds() > kYear2200_s)
    return fmt::format("{:.0f} s", stamp.seconds());
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(static_cast<std::time_t>(stamp.seconds())));
}

std::string drives_text(const FieldMap& map) {
  if (map.drives.empty()) return {};
  std::string text = "made of\n";
  const std::vector<Share> share = shares(map);
  for (std::size_t i = 0; i < share.size(); ++i) {
    text += fmt::format("  {} ({}): {} fingerprints, the newest on {:.1f} m2", map.drives[i].name,
                        date(map.drives[i].first), share[i].fingerprints, share[i].newest_m2);
    text += share[i].replaced > 0 ? fmt::format("; {} replaced\n", share[i].replaced) : "\n";
  }
  return text;
}

nlohmann::ordered_json drives_json(const FieldMap& map) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  const std::vector<Share> share = shares(map);
  for (std::size_t i = 0; i < share.size(); ++i)
    json.push_back({{"log", map.drives[i].name},
                    {"from", date(map.drives[i].first)},
                    {"to", date(map.drives[i].last)},
                    {"fingerprints", share[i].fingerprints},
                    {"replaced", share[i].replaced},
                    {"newest_on_m2", share[i].newest_m2}});
  return json;
}

std::string coverage_text(const FieldMap& map) {
  constexpr std::size_t kMost = 5;
  const SurveyCoverage coverage = survey_coverage(map);
  std::string text = fmt::format("covered {:.0f} m2 of {:.0f} m2 of ground ({:.0f} %)", coverage.covered_m2,
                                 coverage.ground_m2, 100 * coverage.covered_m2 / coverage.ground_m2);
  for (std::size_t i = 0; i < std::min(kMost, coverage.gaps.size()); ++i)
    text +=
        fmt::format("{} {:.1f} m2 about ({:.1f}, {:.1f})", i == 0 ? "; not" : ",", coverage.gaps[i].area_m2,
                    coverage.gaps[i].inside_m.x(), coverage.gaps[i].inside_m.y());
  if (coverage.gaps.size() > kMost) text += fmt::format(" and {} more", coverage.gaps.size() - kMost);
  text += "\n";
  if (coverage.one_way_share > 0.01)
    text += fmt::format("{:.0f} % of the way was driven in one direction only: a bias cannot show there\n",
                        100 * coverage.one_way_share);
  return text;
}

nlohmann::ordered_json coverage_json(const FieldMap& map) {
  const SurveyCoverage coverage = survey_coverage(map);
  nlohmann::ordered_json json{{"ground_m2", coverage.ground_m2},
                              {"covered_m2", coverage.covered_m2},
                              {"one_way_share", coverage.one_way_share},
                              {"gaps", nlohmann::ordered_json::array()}};
  for (const CoverageGap& gap : coverage.gaps)
    json["gaps"].push_back({{"x_m", gap.inside_m.x()}, {"y_m", gap.inside_m.y()}, {"area_m2", gap.area_m2}});
  return json;
}

}  // namespace mstsl::app
