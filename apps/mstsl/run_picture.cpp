#include "run_picture.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "mstsl/io/estimates.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/truth.hpp"
#include "mstsl/viz/picture.hpp"

namespace mstsl::app {
namespace {

/// The estimate when a third of the way to the first pose was driven; the last one where there is none.
const Estimate& on_the_way_to_a_pose(const std::vector<Estimate>& estimates) {
  const auto known = [](const Estimate& e) { return e.map_T_base.has_value(); };
  const auto first = std::ranges::find_if(estimates, known);
  if (first == estimates.end()) return estimates.back();
  const double begin_m = estimates.front().travelled_m;
  const double third_m = begin_m + (first->travelled_m - begin_m) / 3.0;
  return *std::ranges::find_if(estimates, [&](const Estimate& e) { return e.travelled_m >= third_m; });
}

/// What the estimates show: hypotheses on the way, and the poses once they were known.
void add_estimates(const std::vector<Estimate>& estimates, viz::RunPicture& picture) {
  if (estimates.empty()) return;
  const Estimate& on_the_way = on_the_way_to_a_pose(estimates);
  for (const Hypothesis& hypothesis : on_the_way.hypotheses)
    picture.hypotheses.push_back({hypothesis.map_T_base, hypothesis.weight, false});
  for (const Estimate& estimate : estimates) {
    if (!estimate.map_T_base) continue;
    if (picture.estimated_path.empty())
      picture.subtitle =
          fmt::format("first pose after {:.1f} m, probability {:.4f}; hypotheses after {:.1f} m",
                      estimate.travelled_m, estimate.probability, on_the_way.travelled_m);
    picture.estimated_path.push_back(*estimate.map_T_base);
  }
  if (picture.estimated_path.empty())
    picture.subtitle =
        fmt::format("no pose in {:.1f} m; hypotheses at the end", estimates.back().travelled_m);
}

Result<void> add_truth(const std::filesystem::path& file, viz::RunPicture& picture) {
  const auto truth = io::read_truth(file);
  if (!truth) return truth.error();
  for (const PoseReading& pose : *truth) picture.true_path.push_back(pose.map_T_base);
  picture.start = truth->front().map_T_base;
  return {};
}

}  // namespace

Result<void> write_run_picture(const RunFiles& files, const std::string& title,
                               const std::filesystem::path& picture_file) {
  const Result<OccupancyGrid> map = io::read_map(files.map);
  if (!map) return map.error();
  const Result<FieldMap> field = io::read_field_map(files.field);
  if (!field) return field.error();
  const auto estimates = io::read_estimates(files.estimates);
  if (!estimates) return estimates.error();

  viz::RunPicture picture;
  picture.title = title;
  picture.field = &*field;
  if (files.truth)
    if (auto done = add_truth(*files.truth, picture); !done) return done;
  add_estimates(estimates->estimates, picture);
  return viz::draw_run(*map, picture).save(picture_file);
}

}  // namespace mstsl::app
