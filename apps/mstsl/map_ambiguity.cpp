#include "map_ambiguity.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mstsl/eval/ambiguity.hpp"
#include "mstsl/eval/statistics.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/viz/places_sheet.hpp"

#include "interrupt.hpp"
#include "output_paths.hpp"
#include "progress.hpp"

namespace mstsl::app {
namespace {

/// All drives together.
struct Tally {
  Rate right, wrong;
  std::size_t places = 0, without_way = 0, never = 0, unsurveyed = 0;
};

Tally tally(const std::vector<AmbiguousPlace>& places) {
  Tally t;
  t.places = places.size();
  for (const AmbiguousPlace& p : places) {
    if (p.drives == 0) ++t.without_way;
    if (p.drives > 0 && p.right == 0) ++t.never;
    if (p.drives > 0 && p.field_known < 0.5) ++t.unsurveyed;
    for (int k = 0; k < p.drives; ++k) t.right.add(k < p.right), t.wrong.add(k < p.wrong);
  }
  return t;
}

std::string text_of(const Tally& t, const AmbiguityOptions& options) {
  const Interval right = wilson_interval(t.right);
  return fmt::format(
      "{} drives of {:g} m from {} places: {:.1f} % answered rightly ({:.1f} to {:.1f} %), {} wrongly, the "
      "rest not yet\n"
      "{} places from which none was answered; {} with no survey nearby; {} from which no straight way "
      "leads\n",
      t.right.of, options.drive_m, t.places - t.without_way, 100 * t.right.share(), 100 * right.low,
      100 * right.high, t.wrong.hits, t.never, t.unsurveyed, t.without_way);
}

std::string json_of(const std::vector<AmbiguousPlace>& places, const AmbiguityOptions& options) {
  const Tally t = tally(places);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const AmbiguousPlace& p : places)
    list.push_back({{"x", p.place_m.x()},
                    {"y", p.place_m.y()},
                    {"drives", p.drives},
                    {"right", p.right},
                    {"wrong", p.wrong},
                    {"field_known", p.field_known}});
  const nlohmann::ordered_json all = {{"drive_m", options.drive_m},
                                      {"spacing_m", options.spacing_m},
                                      {"seed", options.seed},
                                      {"drives", t.right.of},
                                      {"right", t.right.hits},
                                      {"wrong", t.wrong.hits},
                                      {"places", list}};
  return all.dump() + "\n";
}

std::vector<viz::PlaceMark> marks_of(const std::vector<AmbiguousPlace>& places) {
  std::vector<viz::PlaceMark> marks;
  for (const AmbiguousPlace& p : places)
    if (p.drives > 0) marks.push_back({p.place_m, static_cast<double>(p.right) / p.drives, p.wrong > 0});
  return marks;
}

}  // namespace

Result<Exit> map_ambiguity(const Session& session, const AmbiguityWish& wish) {
  std::vector<std::filesystem::path> outputs;
  for (const auto& file : {wish.output, wish.picture})
    if (file) outputs.push_back(*file);
  if (auto error = overwritten_input(outputs, {wish.map, wish.field})) return *std::move(error);
  Result<OccupancyGrid> grid = io::read_map(wish.map);
  if (!grid) return grid.error();
  Result<FieldMap> field = io::read_field_map(wish.field);
  if (!field) return field.error();
  auto maps =
      make_localization_maps(std::move(grid).value(), std::move(field).value(), {.threads = session.threads});
  if (!maps) return maps.error().within(wish.field.string());
  AmbiguityOptions options = wish.options;
  options.seed = session.seed;
  options.threads = session.threads;
  Progress progress("driving", session.quiet);
  options.progress = [&](double share) { return progress.show(share), !interrupted(); };
  const auto places = find_ambiguity(*maps, options);
  if (!places) return places.error();
  if (wish.output)
    if (const auto written = io::write_file(*wish.output, json_of(*places, options)); !written)
      return written.error();
  const std::string text = text_of(tally(*places), options);
  if (wish.picture) {
    const std::string first_line = text.substr(0, text.find('\n'));
    const auto drawn =
        viz::draw_places((*maps)->occupancy, marks_of(*places), options.spacing_m,
                         fmt::format("Who is switched on here and drives {:g} m", options.drive_m),
                         first_line, "drives answered rightly (%)")
            .save(*wish.picture);
    if (!drawn) return drawn.error();
  }
  if (session.json)
    fmt::print("{}", json_of(*places, options));
  else if (!session.quiet)
    fmt::print("{}", text);
  return Exit::kDone;
}

}  // namespace mstsl::app
