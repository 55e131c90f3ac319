#include "topic_options.hpp"

#include <CLI/CLI.hpp>

namespace mstsl::app {

void add_topic_options(CLI::App& command, io::PlayOptions& options) {
  const auto add = [&command](const char* flag, std::string& name, const char* what) {
    command.add_option(flag, name, what)->capture_default_str()->group("Names in the log");
  };
  add("--scan-topic", options.topics.scan, "LaserScan messages");
  add("--field-topic", options.topics.magnetic_field, "MagneticField messages");
  add("--odometry-topic", options.topics.odometry, "Odometry messages");
  add("--tf-topic", options.topics.transforms_static, "TFMessage messages with the sensors' mounting");
  add("--base-frame", options.base_frame, "Frame of the robot's base");
}

}  // namespace mstsl::app
