#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/core/sensor_data.hpp"
#include "mstsl/io/recording.hpp"

#include "session.hpp"

namespace mstsl::app {

/// Hands an event to whoever takes its kind.
template <typename Consumer>
void hand_over(Consumer& consumer, const SensorEvent& event) {
  std::visit(
      [&](const auto& reading) {
        if constexpr (requires { consumer.observe(reading); }) consumer.observe(reading);
      },
      event);
}

/// io::play with a bar, labelled `what`; an interrupt is an error.
Result<io::PlayReport> play_logs(const Session& session, const std::vector<std::filesystem::path>& logs,
                                 const io::PlayOptions& play, const std::string& what,
                                 const std::function<void(const io::RecordingHeader&)>& on_header,
                                 const std::function<bool(const SensorEvent&)>& on_event);

}  // namespace mstsl::app
