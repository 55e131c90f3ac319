#include "io/log/frame_tree.hpp"

#include <deque>
#include <set>

namespace mstsl::io {

std::string_view frame_name(std::string_view frame_id) {
  while (frame_id.starts_with('/')) frame_id.remove_prefix(1);
  return frame_id;
}

void FrameTree::add(std::string_view parent, std::string_view child,
                    const Eigen::Isometry3d& parent_T_child) {
  const std::string a(frame_name(parent));
  const std::string b(frame_name(child));
  neighbours_[a].insert_or_assign(b, parent_T_child);
  neighbours_[b].insert_or_assign(a, parent_T_child.inverse());
}

bool FrameTree::has(std::string_view frame) const { return neighbours_.contains(frame_name(frame)); }

std::vector<std::string> FrameTree::frames() const {
  std::vector<std::string> names;
  for (const auto& [name, unused] : neighbours_) names.push_back(name);
  return names;
}

std::optional<Eigen::Isometry3d> FrameTree::find(std::string_view to, std::string_view from) const {
  struct Reached {
    std::string frame;
    Eigen::Isometry3d to_T_frame;
  };
  const std::string_view goal = frame_name(from);
  std::deque<Reached> queue{{std::string(frame_name(to)), Eigen::Isometry3d::Identity()}};
  std::set<std::string, std::less<>> seen{queue.front().frame};
  while (!queue.empty()) {
    const Reached here = queue.front();
    queue.pop_front();
    if (here.frame == goal) return here.to_T_frame;
    const auto neighbours = neighbours_.find(here.frame);
    if (neighbours == neighbours_.end()) continue;
    for (const auto& [name, frame_T_neighbour] : neighbours->second)
      if (seen.insert(name).second) queue.push_back({name, here.to_T_frame * frame_T_neighbour});
  }
  return std::nullopt;
}

}  // namespace mstsl::io
