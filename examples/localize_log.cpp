// Localizes a log with the library: the whole program that a user needs.
#include <cstdio>
#include <memory>
#include <optional>

#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/localize/two_step.hpp"

namespace {

int fail(const mstsl::Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: localize_log map.yaml field.nc drive.mcap\n");
    return 2;
  }
  auto occupancy = mstsl::io::read_map(argv[1]);
  if (!occupancy) return fail(occupancy.error());
  auto field = mstsl::io::read_field_map(argv[2]);
  if (!field) return fail(field.error());
  const auto maps = mstsl::make_localization_maps(*std::move(occupancy), *std::move(field));
  if (!maps) return fail(maps.error());

  std::optional<mstsl::TwoStep> localizer;
  const auto played = mstsl::io::play(
      {argv[3]}, {}, [&](const mstsl::io::RecordingHeader& header) { localizer.emplace(*maps, header.rig); },
      [&](const mstsl::SensorEvent& event) {
        mstsl::feed(*localizer, event);
        return true;
      });
  if (!played) return fail(played.error());

  const mstsl::Estimate estimate = localizer->estimate();
  if (!estimate.map_T_base) {
    std::printf("not localized after %.1f m\n", estimate.travelled_m);
    return 3;
  }
  std::printf("x %.3f m, y %.3f m, yaw %.4f rad, probability %.3f\n", estimate.map_T_base->x,
              estimate.map_T_base->y, estimate.map_T_base->yaw, estimate.probability);
  return 0;
}
