#include "run_picture.hpp"

#include <vector>

#include <fmt/format.h>

#include "mstsl/io/estimates.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/truth.hpp"
#include "mstsl/viz/picture.hpp"

namespace mstsl::app {
namespace {

/// What the estimates show: the first hypotheses, and the poses once they were known.
void add_estimates(const std::vector<Estimate>& estimates, viz::RunPicture& picture) {
  for (const Estimate& estimate : estimates) {
    if (picture.hypotheses.empty())
      for (const Hypothesis& hypothesis : estimate.hypotheses)
        picture.hypotheses.push_back({hypothesis.map_T_base, hypothesis.weight, false});
    if (!estimate.map_T_base) continue;
    if (picture.estimated_path.empty())
      picture.subtitle = fmt::format("{} initial hypotheses; first pose after {:.1f} m, probability {:.2f}",
                                     picture.hypotheses.size(), estimate.travelled_m, estimate.probability);
    picture.estimated_path.push_back(*estimate.map_T_base);
  }
}

}  // namespace

Result<void> write_run_picture(const RunFiles& files, const std::filesystem::path& png) {
  const Result<OccupancyGrid> map = io::read_map(files.map);
  if (!map) return map.error();
  const Result<FieldMap> field = io::read_field_map(files.field);
  if (!field) return field.error();
  const auto truth = io::read_truth(files.truth);
  if (!truth) return truth.error();
  const auto estimates = io::read_estimates(files.estimates);
  if (!estimates) return estimates.error();

  viz::RunPicture picture;
  picture.title = "Where am I? Magnetic field, LiDAR and odometry in a symmetric building";
  picture.field = &*field;
  for (const PoseReading& pose : *truth) picture.true_path.push_back(pose.map_T_base);
  picture.start = truth->front().map_T_base;
  add_estimates(estimates->estimates, picture);
  return viz::draw_run(*map, picture).save(png);
}

}  // namespace mstsl::app
