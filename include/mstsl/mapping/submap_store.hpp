#pragma once

#include <cstddef>
#include <deque>
#include <list>
#include <span>
#include <utility>
#include <vector>

#include "mstsl/mapping/field_evidence.hpp"
#include "mstsl/mapping/keyframe.hpp"
#include "mstsl/mapping/pose_graph.hpp"
#include "mstsl/mapping/submap.hpp"

namespace mstsl {

struct SubmapOptions {
  double submap_m = 5.0;   ///< way in a submap
  double stretch_m = 4.0;  ///< way whose scans and field are compared with submaps together
};

/// The drives so far in pieces: whole submaps, the one being made, and the last metres. Of places that were
/// seen before, the older submap alone is kept, so that memory grows with the building and not with the time.
class SubmapStore {
 public:
  explicit SubmapStore(const SubmapOptions& options) : options_(options) {}

  /// What follows is another drive, by another robot perhaps: nothing is joined across.
  void begin_drive(const Eigen::Vector2d& magnetometer_base_m);
  void add(const Keyframe& keyframe);

  const std::vector<Submap>& submaps() const { return submaps_; }
  const std::deque<Keyframe>& last_metres() const { return stretch_; }
  /// Their scans and field in the frame of the last keyframe.
  Stretch stretch() const;
  int drive() const { return drive_; }
  std::size_t keyframes() const { return keyframes_; }  ///< added
  std::size_t keyframes_kept() const;
  const FieldVariogram& variogram() const { return variogram_; }

  /// What matching needs of a submap; good until the next call.
  const SubmapWalls& walls_of(std::size_t submap);

  /// If the newest whole submap goes along one of these, whose places relative to it are well known, the same
  /// way round, it shows nothing more and is let go.
  void let_go_where_known(std::span<const std::size_t> known, const PoseGraph& graph);

 private:
  void end_submap();

  SubmapOptions options_;
  int drive_ = -1;
  Eigen::Vector2d magnetometer_base_m_{0, 0};
  std::vector<Submap> submaps_;
  std::vector<Keyframe> open_;    ///< of the submap being made
  std::deque<Keyframe> stretch_;  ///< the last metres
  std::size_t keyframes_ = 0;
  std::list<std::pair<std::size_t, SubmapWalls>> ready_;  ///< made last, first
  FieldVariogram variogram_;
};

}  // namespace mstsl
