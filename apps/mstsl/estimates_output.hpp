#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "mstsl/core/result.hpp"
#include "mstsl/io/estimates.hpp"
#include "mstsl/io/tum.hpp"

namespace mstsl::app {

/// The estimates of a run as they are written, and what went wrong with that.
class EstimatesOutput {
 public:
  static Result<EstimatesOutput> open(const std::filesystem::path& estimates,
                                      const std::optional<std::filesystem::path>& tum);

  void write(const Estimate& estimate);
  void close(const io::Summary& summary);
  /// The first error; nothing is written after it.
  const std::optional<Error>& error() const { return error_; }

 private:
  explicit EstimatesOutput(io::EstimatesWriter estimates) : estimates_(std::move(estimates)) {}
  void keep(const Result<void>& result);

  io::EstimatesWriter estimates_;
  std::optional<io::TumWriter> tum_;
  std::optional<Error> error_;
};

}  // namespace mstsl::app
