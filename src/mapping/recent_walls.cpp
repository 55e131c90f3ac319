#include "mstsl/mapping/recent_walls.hpp"

namespace mstsl {

RecentWalls::RecentWalls(double recent_m, const ScannedWallsOptions& options)
    : recent_m_(recent_m), options_(options), walls_({0, 0}, options) {}

void RecentWalls::add(const std::vector<FacedPoint>& points_base_m, const Pose2& chain_T_base) {
  const double travelled_m =
      drawn_.empty() ? 0.0 : drawn_.back().travelled_m + distance(drawn_.back().chain_T_base, chain_T_base);
  drawn_.push_back({points_base_m, chain_T_base, travelled_m});
  constexpr std::size_t kMost = 150;  // who turns on the spot all day has no older ones by the way driven
  while (drawn_.size() > kMost || travelled_m - drawn_.front().travelled_m > recent_m_) drawn_.pop_front();
  // Begun anew now and then, so that only the last metres are in it and the robot stays near its middle.
  const bool anew = ++drawn_since_ > drawn_.size() + 10 ||
                    (chain_T_base.position() - walls_.center_m()).norm() > 0.4 * options_.half_size_m;
  if (!anew) return walls_.add(points_base_m, chain_T_base);
  walls_ = ScannedWalls(chain_T_base.position(), options_);
  for (const Drawn& d : drawn_) walls_.add(d.points_base_m, d.chain_T_base);
  drawn_since_ = 0;
}

}  // namespace mstsl
