#include "io/carmen/parse.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <utility>

namespace mstsl::io::carmen {
namespace {

/// The year 2096; what lies beyond is damage, and would overflow differences of nanoseconds in 64 bits.
constexpr double kLatestTime_s = 4e9;

/// Takes the words of a line one by one; the first that is missing or no number makes it fail for good.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  bool ok() const { return ok_; }
  void fail() { ok_ = false; }

  std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t"));
    rest_.remove_prefix(word.size());
    return word;
  }

  template <typename T>
  T number() {
    const std::string_view text = word();
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) ok_ = false;
    return value;
  }

  Pose2 pose() {
    const auto x = number<double>();
    const auto y = number<double>();
    const auto yaw = number<double>();
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(yaw)) ok_ = false;
    return ok_ ? Pose2::from({x, y}, yaw) : Pose2{};
  }

  double time() {
    const auto time_s = number<double>();
    if (!(std::abs(time_s) < kLatestTime_s)) ok_ = false;
    return time_s;
  }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

Line parse_odometry(Words words) {
  OdometryLine line;
  line.pose = words.pose();
  for (int i = 0; i < 3; ++i) words.number<double>();  // speeds and acceleration, mostly zeros
  line.time_s = words.time();
  if (!words.ok()) return DamagedLine{};
  return line;
}

Line parse_scan(Words words) {
  ScanLine line;
  const auto beams = words.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < beams && words.ok(); ++i) line.ranges_m.push_back(words.number<float>());
  line.pose = words.pose();
  line.odometry = words.pose();
  line.time_s = words.time();
  if (!words.ok()) return DamagedLine{};
  return line;
}

}  // namespace

Line parse_line(std::string_view line) {
  Words words(line);
  const std::string_view kind = words.word();
  if (kind == "ODOM") return parse_odometry(words);
  if (kind == "FLASER") return parse_scan(words);
  return OtherLine{};
}

bool is_typical(std::string_view line) {
  constexpr std::array<std::string_view, 6> kKinds{"PARAM", "ODOM", "FLASER", "RLASER", "SYNC", "NEFF"};
  if (line.starts_with("# message_name") || line.starts_with("# message formats defined")) return true;
  return std::ranges::find(kKinds, Words(line).word()) != kKinds.end();
}

}  // namespace mstsl::io::carmen
