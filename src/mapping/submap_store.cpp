#include "mstsl/mapping/submap_store.hpp"

#include <algorithm>
#include <cmath>

namespace mstsl {
namespace {

constexpr double kSpacing_m = 0.2;  // of a stretch's points

}  // namespace

void SubmapStore::begin_drive(const Eigen::Vector2d& magnetometer_base_m) {
  if (!open_.empty()) end_submap();
  stretch_.clear();
  ++drive_;
  magnetometer_base_m_ = magnetometer_base_m;
}

void SubmapStore::add(const Keyframe& keyframe) {
  open_.push_back(keyframe);
  stretch_.push_back(keyframe);
  while (keyframe.travelled_m - stretch_.front().travelled_m > options_.stretch_m) stretch_.pop_front();
  constexpr std::size_t kMost = 60;  // who turns on the spot all day
  while (stretch_.size() > kMost) stretch_.pop_front();
  ++keyframes_;
  const bool full =
      keyframe.travelled_m - open_.front().travelled_m >= options_.submap_m || open_.size() >= kMost;
  if (full) end_submap();
}

void SubmapStore::end_submap() {
  Submap submap;
  submap.drive = drive_, submap.magnetometer_base_m = magnetometer_base_m_;
  submap.last = keyframes_ - 1;
  submap.first = keyframes_ - open_.size();
  submap.origin = submap.first + open_.size() / 2;
  submap.begin_m = open_.front().travelled_m, submap.end_m = open_.back().travelled_m;
  const std::size_t middle = submap.origin - submap.first;
  for (const Keyframe& k : open_)
    submap.way_m.push_back(between(open_[middle].chain_T_base, k.chain_T_base).position());
  variogram_.add(stretch_of(open_, middle, magnetometer_base_m_, kSpacing_m).fields);
  submap.keyframes = std::move(open_);
  open_.clear();
  submaps_.push_back(std::move(submap));
}

Stretch SubmapStore::stretch() const {
  const std::vector<Keyframe> keyframes(stretch_.begin(), stretch_.end());
  return stretch_of(keyframes, keyframes.size() - 1, magnetometer_base_m_, kSpacing_m);
}

const SubmapWalls& SubmapStore::walls_of(std::size_t submap) {
  constexpr std::size_t kKept = 12;
  const auto at =
      std::find_if(ready_.begin(), ready_.end(), [&](const auto& r) { return r.first == submap; });
  if (at != ready_.end())
    ready_.splice(ready_.begin(), ready_, at);
  else
    ready_.emplace_front(submap, SubmapWalls(submaps_[submap]));
  if (ready_.size() > kKept) ready_.pop_back();
  return ready_.front().second;
}

void SubmapStore::let_go_where_known(std::span<const std::size_t> known, const PoseGraph& graph) {
  if (submaps_.empty()) return;
  Submap& newest = submaps_.back();
  if (newest.keyframes.empty() || stretch_.back().travelled_m - newest.end_m > options_.stretch_m) return;
  const bool shows_nothing_new = std::any_of(known.begin(), known.end(), [&](std::size_t k) {
    const Submap& older = submaps_[k];
    if (&older == &newest || older.keyframes.empty()) return false;
    const Pose2 there = between(graph.pose(older.origin), graph.pose(newest.origin));
    constexpr double kNear_m = 0.75, kAlike_rad = 0.8;
    return older.distance_m(there.position()) < kNear_m && std::abs(there.yaw) < kAlike_rad;
  });
  if (!shows_nothing_new) return;
  ready_.remove_if([&](const auto& r) { return r.first + 1 == submaps_.size(); });
  newest.keyframes.clear();
  newest.keyframes.shrink_to_fit();
}

std::size_t SubmapStore::keyframes_kept() const {
  std::size_t kept = open_.size() + stretch_.size();
  for (const Submap& s : submaps_) kept += s.keyframes.size();
  return kept;
}

}  // namespace mstsl
