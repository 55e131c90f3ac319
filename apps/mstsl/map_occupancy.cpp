#include "map_occupancy.hpp"

#include <fmt/format.h>

#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/map_server.hpp"

#include "drive_report.hpp"
#include "output_paths.hpp"
#include "warnings.hpp"

namespace mstsl::app {

Result<Exit> map_occupancy(const Session& session, const OccupancyMapWish& wish) {
  std::vector<std::filesystem::path> outputs{wish.output};
  for (const auto& file : {wish.tum, wish.report, wish.picture})
    if (file) outputs.push_back(*file);
  if (auto error = overwritten_input(outputs, wish.drives.logs)) return *std::move(error);
  const Result<MappedDrives> mapped = map_drives(session, wish.drives);
  if (!mapped) return mapped.error();
  warn(session, mapped->warnings);
  if (const auto written = io::write_map(mapped->grid, wish.output); !written) return written.error();
  if (wish.tum)
    if (const auto written = write_ways(*mapped, *wish.tum); !written) return written.error();
  if (wish.report)
    if (const auto written = io::write_file(*wish.report, drive_report_json(*mapped) + "\n"); !written)
      return written.error();
  if (wish.picture)
    if (const auto written = draw_ways(*mapped, nullptr, wish.output.filename().string()).save(*wish.picture);
        !written)
      return written.error();
  if (session.json)
    fmt::print("{}\n", drive_report_json(*mapped));
  else if (!session.quiet)
    fmt::print("{}written to {}\n", drive_report_text(*mapped), wish.output.string());
  return Exit::kDone;
}

}  // namespace mstsl::app
