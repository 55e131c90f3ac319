#include <memory>

#include <CLI/CLI.hpp>

#include "mstsl/localize/methods.hpp"

#include "calibration_option.hpp"
#include "localize_log.hpp"
#include "topic_options.hpp"

namespace mstsl::app {

void add_localize(CLI::App& app, Session& session) {
  auto wish = std::make_shared<LocalizeWish>();
  CLI::App* command = app.add_subcommand("localize", "Find where the robot of a log is");
  command->add_option("--map", wish->map, "Occupancy map: a map_server yaml")->required();
  command->add_option("--field", wish->field, "Field map, as `mstsl map magnetic` makes it")->required();
  command->add_option("--method", wish->method, "How to localize")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  command
      ->add_option(
          "-k,--hypotheses", wish->hypotheses,
          "Two-step method: initial hypotheses kept (the paper's K: 5 in its corridor, 8 in its car park)")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--probability", wish->localized_from,
                   "Joint method: a pose is published from this probability of being right on")
      ->check(CLI::Range(0.5, 0.999999))
      ->capture_default_str();
  command->add_option("-o,--output", wish->output, "Estimates, as JSON Lines")->required();
  command->add_option("--tum", wish->tum, "Also the trajectory, in the format that evo reads");
  command->add_option("--picture", wish->picture,
                      "Also a picture, PNG or SVG: the way on the map, with the field under it");
  command->add_option(
      "--report", wish->report,
      "Also a page, HTML, to look at the run again: scans, hypotheses and probability over time");
  command->add_option("--truth", wish->truth, "The true way, to be shown in picture and report");
  command
      ->add_option("logs", wish->logs,
                   "MCAP, rosbag2 folder, ROS 1 bag or CARMEN log; several are one after the other")
      ->required();
  add_calibration_option(*command, wish->calibration);
  add_topic_options(*command, wish->play);
  add_common_options(*command, session);
  command->callback(
      [wish, &session] { session.work = [wish, &session] { return localize_log(session, *wish); }; });
}

}  // namespace mstsl::app
