#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "message_support.hpp"

namespace mstsl::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A folder for logs, and what playing one complains of.
class Play : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name = "log.mcap") const { return folder_.path() / name; }
  std::string error(const io::PlayOptions& options = {}) const {
    const auto played = try_play({path()}, options);
    return played.ok() ? std::string() : played.error().message();
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace mstsl::test
