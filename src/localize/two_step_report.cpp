#include <fmt/format.h>

#include "mstsl/localize/two_step.hpp"

namespace mstsl {

LocalizerReport TwoStep::report() const {
  LocalizerReport report;
  const auto note = [&report](const std::string& what, std::uint64_t count) {
    if (count > 0) report.counts[what] += count;
  };
  note("odometry readings dropped (not finite or out of order)", track_.dropped());
  note("odometry interruptions", track_.breaks());
  note("scans dropped (out of order)", counts_.late_scans);
  note("scans dropped (no odometry near their time)", counts_.scans_without_odometry);
  note("scans without enough returns", counts_.blind_scans);
  note("field readings dropped (not finite or out of order)", counts_.bad_field);
  note("field readings dropped (no odometry near their time)", counts_.field_without_odometry);
  note("searches", counts_.searches);
  note("searches that removed every hypothesis", counts_.all_rejected);
  note("times lost", counts_.times_lost);
  for (const Rejection reason : {Rejection::kOutOfMap, Rejection::kCrossesWall, Rejection::kLowScore})
    note(fmt::format("hypotheses removed ({})", to_string(reason)),
         counts_.removed[static_cast<std::size_t>(reason)]);
  if (counts_.field_used == 0)
    report.warnings.emplace_back(
        "no usable field reading was seen: the two-step method cannot start without one");
  const auto* gathering = std::get_if<Gathering>(&phase_);
  if (gathering && last_step_ && !gathering->reading.has_line())
    report.warnings.emplace_back(
        "no straight wall was found in the scans: the two-step method cannot align itself");
  return report;
}

}  // namespace mstsl
