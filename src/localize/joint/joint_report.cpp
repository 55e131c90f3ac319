#include "mstsl/localize/joint/joint.hpp"

namespace mstsl {

LocalizerReport Joint::report() const {
  LocalizerReport report;
  const auto note = [&report](const char* what, std::uint64_t count) {
    if (count > 0) report.counts[what] += count;
  };
  note("odometry readings dropped (not finite or out of order)", track_.dropped());
  note("odometry interruptions", track_.breaks());
  note("scans dropped (out of order)", counts_.late_scans);
  note("scans dropped (no odometry near their time)", counts_.scans_without_odometry);
  note("scans without enough returns", counts_.blind_scans);
  note("field readings dropped (not finite or out of order)", counts_.bad_field);
  note("field readings dropped (no odometry near their time)", counts_.field_without_odometry);
  note("field stations", counts_.stations);
  note("searches", counts_.searches);
  note("searches cut short", counts_.cut_searches);
  note("searches by the field alone", counts_.field_searches);
  note("times lost", counts_.times_lost);
  if (counts_.stations == 0 && track_.travelled_m() > 1.0)
    report.warnings.emplace_back(
        "no usable field reading was seen: the walls alone cannot tell places apart that look alike");
  if (counts_.searches + counts_.field_searches == 0 && processed_)
    report.warnings.emplace_back(
        "no place was found where a scan fits the map: check the map, the laser's mounting in /tf_static and "
        "that the scans have returns");
  return report;
}

}  // namespace mstsl
