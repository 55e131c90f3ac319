#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/localize/estimate.hpp"

namespace mstsl::io {

/// One figure of a run's summary: a count, a measure, a word, or null.
using SummaryValue = std::variant<std::nullptr_t, bool, std::int64_t, double, std::string>;

/// What a run says of itself in its last line, by name (units in the names). Written in the order of the
/// names.
using Summary = std::map<std::string, SummaryValue>;

/// Writes estimates as JSON Lines, one object a scan:
///   {"t": s, "travelled_m", "status", "pose": {"x", "y", "yaw"} | null, "covariance": [9] (row-major x y
///   yaw),
///    "probability", "hypotheses": [{"x", "y", "yaw", "weight"}] (at most 20, best first), "bias_uT": [3] |
///    null}
/// and a last line {"summary": {...}}. Numbers keep their full precision; a number that is not finite is an
/// error of its maker and refused. Each line is handed to the system at once: an interrupted run keeps what
/// it has in NAME.part.
class EstimatesWriter {
 public:
  static Result<EstimatesWriter> open(const std::filesystem::path& file);

  Result<void> write(const Estimate& estimate);
  /// Adds the last line and gives the file its final name.
  Result<void> close(const Summary& summary);
  /// Gives the file its final name without a summary, as after an interruption.
  Result<void> close();

 private:
  explicit EstimatesWriter(AtomicFile file) : file_(std::move(file)) {}
  AtomicFile file_;
};

/// A file of estimates; `summary` is absent where the run was interrupted.
struct EstimatesFile {
  std::vector<Estimate> estimates;
  std::optional<Summary> summary;
};

/// Reads what EstimatesWriter writes; a last line that was cut off by an interruption is passed over. Stamps
/// come through a double (0.2 us in Unix time). Errors: any other line that is no such object, with its
/// number.
Result<EstimatesFile> read_estimates(const std::filesystem::path& file);

/// One line of the file, without the line feed; a sentence where a number is not finite.
Result<std::string> to_json_line(const Estimate& estimate);

}  // namespace mstsl::io
