#pragma once

#include "mstsl/io/recording.hpp"

namespace CLI {
class App;
}

namespace mstsl::app {

/// Adds --scan-topic, --field-topic, --odometry-topic, --tf-topic and --base-frame to a subcommand that reads
/// logs.
void add_topic_options(CLI::App& command, io::PlayOptions& options);

}  // namespace mstsl::app
