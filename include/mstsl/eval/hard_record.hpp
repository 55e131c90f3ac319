#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/metrics.hpp"

namespace mstsl {

/// Which run it is.
struct HardKey {
  std::string set, world, disturbance, method;
  int run = 0;
  friend bool operator==(const HardKey&, const HardKey&) = default;
};

/// How much CPU time the scans took that were processed, each with all readings since the last such one: a
/// histogram, so that runs add up.
class CostHistogram {
 public:
  static constexpr std::size_t kBins = 120;
  void add(double ms);
  void add(const CostHistogram& other);
  std::size_t count() const;
  /// The upper edge of the bin that holds this share, ms (bins are 12 % wide); 0 without scans.
  double quantile_ms(double q) const;
  double max_ms() const { return max_ms_; }

  std::array<std::uint32_t, kBins> bins{};
  double max_ms_ = 0.0;
};

/// What followed after the robot was set down elsewhere. Distances driven since then, m.
struct KidnapOutcome {
  bool localized_before = false;      ///< the last pose before was given and right
  std::optional<double> noticed_m;    ///< until no pose, or a right one, was given
  std::optional<double> recovered_m;  ///< until a right pose was given
  bool wrong_again = false;           ///< a wrong pose was given after it was noticed
};

/// All that is kept of one run of one method.
struct HardRecord {
  HardKey key;
  std::string options;  ///< seed, length, lidar ...: what else decides the run
  double driven_m = 0.0;
  double duration_s = 0.0;
  std::size_t estimates = 0;
  std::size_t answers = 0;
  std::size_t claims_at_99 = 0, wrong_at_99 = 0;  ///< answers claimed at >= 0.99; the wrong ones
  std::size_t claims_at_999 = 0, wrong_at_999 = 0;
  std::optional<JudgedAnswer> first, last;
  std::optional<double> first_s;             ///< from the first event to the first pose
  std::optional<double> correct_distance_m;  ///< CLD
  std::vector<JudgedAnswer> sample;          ///< answers after the first, thinned to equal steps
  std::size_t times_lost = 0;
  std::size_t false_alarms = 0;  ///< a right pose was withdrawn
  double right_m = 0.0;          ///< driven with a right pose
  std::optional<KidnapOutcome> kidnap;
  CostHistogram searching, tracking;  ///< cost of scans without and with a pose afterwards
  double simulation_ms = 0.0;         ///< CPU time of the simulation itself, of all methods' run

  /// RunEvaluation::succeeded().
  bool succeeded() const { return first && first->right && correct_distance_m; }
};

/// One line of JSON, without the line's end; and back. Errors: what is no such line.
std::string to_line(const HardRecord& record);
Result<HardRecord> record_from_line(std::string_view line);

}  // namespace mstsl
