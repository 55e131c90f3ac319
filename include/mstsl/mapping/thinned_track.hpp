#pragma once

#include <vector>

#include "mstsl/core/trajectory.hpp"

namespace mstsl {

/// A track of a drive of hours: of its poses those are kept between which all others lie, to a millimetre and
/// three hundredths of a degree, and at least four a second.
class ThinnedTrack {
 public:
  /// The next pose; one that is not later than the last is left out.
  void add(const TimedPose& at);

  /// The last of them is always the last one added.
  const std::vector<TimedPose>& poses() const { return poses_; }

 private:
  bool lie_between(const TimedPose& from, const TimedPose& to) const;

  std::vector<TimedPose> poses_;
  std::vector<TimedPose> left_out_;  ///< since the last but one of them
};

}  // namespace mstsl
