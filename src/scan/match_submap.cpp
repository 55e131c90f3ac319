#include "mstsl/scan/match_submap.hpp"

#include <utility>
#include <vector>

namespace mstsl {

MatchMap::MatchMap(OccupancyGrid map, const LikelihoodOptions& options, int pyramid_levels)
    : occupancy(std::move(map)), field(occupancy, options), pyramid(field, pyramid_levels) {}

std::optional<SubmapMatch> match_submap(const MatchMap& map, const PointSet& local_points_base_m,
                                        const PointSet& scan_points_base_m, const PosePrior& prior,
                                        const SubmapMatchOptions& options) {
  const PointSet points = at_most(local_points_base_m, options.max_points);
  const SearchWindow window =
      SearchWindow::around(prior.mean, prior.covariance, options.window_sigmas, map.occupancy.geometry());
  const std::vector<ScoredPose> found = search_poses(map.pyramid, points, window, options.search);
  if (found.empty()) return std::nullopt;
  SubmapMatch match;
  match.refined = refine_pose(map.field, points, found.front().map_T_base, prior, options.refine);
  match.search_score = found.front().score;
  match.confidence =
      confidence_score(map.occupancy, scan_points_base_m, match.refined.map_T_base, options.score);
  return match;
}

}  // namespace mstsl
