#include "mstsl/scan/branch_and_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <queue>
#include <tuple>

#include "mstsl/core/angles.hpp"

namespace mstsl {
namespace {

/// The scan at one heading of the lattice, standing at the window's centre: the cell that each point falls
/// into.
struct TurnedScan {
  double turn_rad = 0.0;  ///< from the window's centre
  std::vector<Cell> cells;
};

/// Shifts (x .. x + 2^level - 1, and y alike, in cells) of one turned scan; at level 0 a single pose.
struct Block {
  int bound = 0;  ///< no pose of the block scores more; at level 0 its score (sum over the points)
  int scan = 0;
  int x = 0;
  int y = 0;
  int level = 0;
};

/// Poses in order: higher score first, then nearer the window's centre, then by index so that there are no
/// ties.
auto rank(const Block& pose) {
  const auto x = static_cast<std::int64_t>(pose.x), y = static_cast<std::int64_t>(pose.y);
  return std::tuple(-pose.bound, x * x + y * y, pose.scan, pose.y, pose.x);
}

/// Which block waits longer. At the same bound blocks are opened before poses are given out, so that poses
/// come out in exactly their order.
struct Later {
  bool operator()(const Block& a, const Block& b) const {
    if (a.bound != b.bound) return a.bound < b.bound;
    if ((a.level == 0) != (b.level == 0)) return a.level == 0;
    return rank(a) > rank(b);
  }
};

/// The largest turn that moves no point over the map by more than a cell (Hess et al. 2016, Eq. 7).
double finest_turn(const PointSet& points, const GridGeometry& geometry) {
  const double diagonal_m = geometry.resolution_m * std::hypot(geometry.columns, geometry.rows);
  double farthest_m = 0;
  for (const Eigen::Vector2d& p : points) farthest_m = std::max(farthest_m, std::min(p.norm(), diagonal_m));
  if (farthest_m <= geometry.resolution_m / 2) return kPi;
  return 2 * std::asin(geometry.resolution_m / (2 * farthest_m));
}

/// The lattice's turns from the window's centre, in the order 0, +1, -1, +2 ... steps.
std::vector<double> turns(double reach_rad, double step_rad) {
  std::vector<double> all{0.0};
  if (reach_rad >= kPi) {
    const auto count = static_cast<int>(std::ceil(2 * kPi / step_rad));
    for (int i = 1; i < count; ++i) all.push_back((i % 2 == 1 ? 1 : -1) * ((i + 1) / 2) * (2 * kPi / count));
    return all;
  }
  const auto count = static_cast<int>(std::ceil(reach_rad / step_rad));
  for (int i = 1; i <= count; ++i) all.insert(all.end(), {i * step_rad, -i * step_rad});
  return all;
}

class Search {
 public:
  Search(const LikelihoodPyramid& map, const PointSet& points, const SearchWindow& window,
         const PoseSearchOptions& options)
      : map_(map), center_(window.center), options_(options), points_(static_cast<int>(points.size())) {
    const GridFrame frame(map.geometry());
    const double step = options.yaw_step_rad > 0 ? options.yaw_step_rad : finest_turn(points, map.geometry());
    for (const double turn : turns(window.reach_rad, step)) scans_.push_back(turned(frame, points, turn));
    const Eigen::Vector2d reach = window.reach_m / map.geometry().resolution_m;
    reach_x_ = static_cast<int>(std::ceil(reach.x() - 1e-9));
    reach_y_ = static_cast<int>(std::ceil(reach.y() - 1e-9));
    min_sum_ =
        static_cast<int>(std::ceil(options.min_score * LikelihoodPyramid::kFullScale * points_ - 1e-9));
  }

  std::vector<ScoredPose> run() {
    open_window();
    while (!queue_.empty() && answers_.size() < options_.max_answers) {
      const Block next = queue_.top();
      queue_.pop();
      if (is_near_an_answer(next)) continue;
      if (next.level == 0) {
        answers_.push_back({pose_of(next.scan, next.x, next.y),
                            next.bound / (static_cast<double>(LikelihoodPyramid::kFullScale) * points_)});
      } else {
        open(next);
      }
    }
    return answers_;
  }

 private:
  TurnedScan turned(const GridFrame& frame, const PointSet& points, double turn) const {
    const Pose2 pose = Pose2::from(center_.position(), center_.yaw + turn);
    const Eigen::Matrix2d rotation = pose.rotation();
    TurnedScan scan{turn, {}};
    scan.cells.reserve(points.size());
    for (const Eigen::Vector2d& p : points)
      scan.cells.push_back(frame.cell_at(rotation * p + pose.position()));
    return scan;
  }

  Pose2 pose_of(int scan, double x, double y) const {
    const GridGeometry& geometry = map_.geometry();
    const Eigen::Vector2d shift_m =
        geometry.map_T_grid.rotation() * (Eigen::Vector2d(x, y) * geometry.resolution_m);
    return Pose2::from(center_.position() + shift_m,
                       center_.yaw + scans_[static_cast<std::size_t>(scan)].turn_rad);
  }

  int bound(int scan, int x, int y, int level) const {
    int sum = 0;
    for (const Cell cell : scans_[static_cast<std::size_t>(scan)].cells)
      sum += map_.at(level, {cell.column + x, cell.row + y});
    return sum;
  }

  void consider(int scan, int x, int y, int level) {
    if (x > reach_x_ || y > reach_y_) return;
    const Block block{bound(scan, x, y, level), scan, x, y, level};
    if (block.bound < min_sum_) return;
    // With a single answer asked for, a pose in hand rules out every block that cannot beat it.
    if (level == 0 && options_.max_answers == 1) min_sum_ = block.bound;
    queue_.push(block);
  }

  /// Covers the window with the coarsest blocks that are not larger than it.
  void open_window() {
    int level = 0;
    while (level + 1 < map_.levels() && (2 << level) <= 2 * std::max(reach_x_, reach_y_) + 1) ++level;
    for (int scan = 0; scan < static_cast<int>(scans_.size()); ++scan) {
      for (int y = -reach_y_; y <= reach_y_; y += 1 << level) {
        for (int x = -reach_x_; x <= reach_x_; x += 1 << level) consider(scan, x, y, level);
      }
    }
  }

  void open(const Block& block) {
    const int half = 1 << (block.level - 1);
    for (const auto& [dx, dy] :
         std::array<std::array<int, 2>, 4>{{{0, 0}, {half, 0}, {0, half}, {half, half}}}) {
      consider(block.scan, block.x + dx, block.y + dy, block.level - 1);
    }
  }

  /// Whether every pose of the block is too near an answer to be one of its own.
  bool is_near_an_answer(const Block& block) const {
    const int far = (1 << block.level) - 1;
    return std::any_of(answers_.begin(), answers_.end(), [&](const ScoredPose& answer) {
      const Pose2 corner = pose_of(block.scan, block.x, block.y);
      if (std::abs(angle_between(corner.yaw, answer.map_T_base.yaw)) >= options_.distinct_rad) return false;
      return std::ranges::all_of(std::array{0, far}, [&](int dx) {
        return std::ranges::all_of(std::array{0, far}, [&](int dy) {
          return distance(pose_of(block.scan, block.x + dx, block.y + dy), answer.map_T_base) <
                 options_.distinct_m;
        });
      });
    });
  }

  const LikelihoodPyramid& map_;
  Pose2 center_;
  PoseSearchOptions options_;
  int points_;
  std::vector<TurnedScan> scans_;
  int reach_x_ = 0;
  int reach_y_ = 0;
  int min_sum_ = 0;
  std::priority_queue<Block, std::vector<Block>, Later> queue_;
  std::vector<ScoredPose> answers_;
};

}  // namespace

SearchWindow SearchWindow::around(const Pose2& map_T_base, const Eigen::Matrix3d& covariance, double sigmas,
                                  const GridGeometry& geometry) {
  const Eigen::Matrix2d grid_R_map = geometry.map_T_grid.rotation().transpose();
  const Eigen::Matrix2d in_grid = grid_R_map * covariance.topLeftCorner<2, 2>() * grid_R_map.transpose();
  return {map_T_base, sigmas * in_grid.diagonal().cwiseMax(0.0).cwiseSqrt(),
          sigmas * std::sqrt(std::max(0.0, covariance(2, 2)))};
}

SearchWindow SearchWindow::whole(const GridGeometry& geometry) {
  const Eigen::Vector2d half = 0.5 * Eigen::Vector2d(geometry.columns, geometry.rows);
  return {Pose2::from(geometry.to_map(half), geometry.map_T_grid.yaw), half * geometry.resolution_m, kPi};
}

std::vector<ScoredPose> search_poses(const LikelihoodPyramid& map, const PointSet& points_base_m,
                                     const SearchWindow& window, const PoseSearchOptions& options) {
  if (points_base_m.empty() || map.geometry().size() == 0) return {};
  return Search(map, points_base_m, window, options).run();
}

}  // namespace mstsl
