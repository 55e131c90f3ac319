#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mstsl/core/result.hpp"

#include "piece_store.hpp"

namespace mstsl {

/// Many threads at pieces of one work: tells of progress, keeps what is finished, and ends early when
/// something fails or an end is asked for. All but end() may be called by any thread.
class Piecework {
 public:
  using Progress = std::function<bool(const char* what, double share)>;

  Piecework(PieceStore& store, Progress progress) : store_(store), progress_(std::move(progress)) {}

  /// How many pieces there are for this process to make.
  void expect(std::size_t pieces) { expected_ = pieces; }
  /// How many of them are made, 0 .. 1.
  double share();
  /// Something is being done that is no piece, and how far it is.
  void tell(const char* what, double share);
  /// Keeps what one piece gave: contents by name.
  void finish(const std::vector<std::pair<std::string, std::string>>& contents);
  void fail(Error error);
  bool stopped() const { return stopped_; }

  /// What came of it. Errors: what failed, a disk that is full, an end that was asked for.
  Result<void> end() const;

 private:
  PieceStore& store_;
  Progress progress_;
  std::size_t expected_ = 0, done_ = 0;
  std::mutex mutex_;
  std::atomic<bool> stopped_ = false;
  std::optional<Error> error_;
};

}  // namespace mstsl
