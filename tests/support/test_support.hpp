#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "mstsl/core/result.hpp"

namespace mstsl::test {

/// The value of a Result; on an error the test fails with its sentence and ends by the exception GoogleTest
/// catches.
template <typename T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error("unexpected error: " + result.error().message());
  return std::move(result).value();
}
inline void must(const Result<void>& result) {
  if (!result) throw std::runtime_error("unexpected error: " + result.error().message());
}

/// An empty folder that goes away with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mstsl-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A file of the real recordings.
inline std::filesystem::path data_file(const std::string& name) {
  return std::filesystem::path(MSTSL_DATA_DIR) / name;
}

}  // namespace mstsl::test

/// Skips the test, saying which real recording is missing.
#define MSTSL_REQUIRE_DATA(name)                              \
  if (!std::filesystem::exists(mstsl::test::data_file(name))) \
  GTEST_SKIP() << "real data absent: " << mstsl::test::data_file(name)
