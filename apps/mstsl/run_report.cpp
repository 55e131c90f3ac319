#include "run_report.hpp"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/estimates.hpp"
#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/truth.hpp"
#include "mstsl/report/page.hpp"

namespace mstsl::app {
namespace {

Result<std::shared_ptr<const TracedPlace>> read_place(const RunFiles& files) {
  Result<OccupancyGrid> map = io::read_map(files.map);
  if (!map) return map.error();
  Result<FieldMap> field = io::read_field_map(files.field);
  if (!field) return field.error();
  return std::make_shared<const TracedPlace>(
      TracedPlace{files.map.string(), std::move(map).value(), std::move(field).value()});
}

}  // namespace

Result<void> RunReport::write(const RunFiles& files, const std::string& title, const std::string& method,
                              const std::filesystem::path& page_file) {
  auto place = read_place(files);
  if (!place) return place.error();
  auto estimates = io::read_estimates(files.estimates);
  if (!estimates) return estimates.error();
  RunTrace run{title, std::move(place).value(), {}, scans_.take(), {}};
  run.methods.push_back({method, std::move(estimates->estimates)});
  if (files.truth) {
    const auto truth = io::read_truth(*files.truth);
    if (!truth) return truth.error();
    for (const PoseReading& pose : *truth) run.truth.add(pose.stamp, pose.map_T_base);
  }
  report::Page page;
  page.title = title;
  page.subtitle = fmt::format("{} on {} with {}", method, files.map.string(), files.field.string());
  page.runs.push_back(std::move(run));
  return io::write_file(page_file, report::html(page));
}

}  // namespace mstsl::app
