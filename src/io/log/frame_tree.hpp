#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace mstsl::io {

/// A frame's name without the leading slash that ROS 1 drivers may put before it.
std::string_view frame_name(std::string_view frame_id);

/// The fixed transforms between the frames of a robot, whichever way round each was given.
class FrameTree {
 public:
  void add(std::string_view parent, std::string_view child, const Eigen::Isometry3d& parent_T_child);

  bool has(std::string_view frame) const;
  std::vector<std::string> frames() const;

  /// to_T_from along the transforms that join the two; nothing where they are not joined.
  std::optional<Eigen::Isometry3d> find(std::string_view to, std::string_view from) const;

 private:
  using Neighbours = std::map<std::string, Eigen::Isometry3d, std::less<>>;  ///< frame_T_neighbour
  std::map<std::string, Neighbours, std::less<>> neighbours_;
};

}  // namespace mstsl::io
