#include "mstsl/io/truth.hpp"

#include <string>

#include <fmt/format.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/io/atomic_file.hpp"
#include "mstsl/io/file_bytes.hpp"

#include "file_problem.hpp"
#include "text_numbers.hpp"

namespace mstsl::io {
namespace {

constexpr std::string_view kHeader = "t,x,y,yaw";
constexpr std::size_t kMaxTruthBytes = std::size_t{1} << 32;

PoseReading parse_row(std::string_view line, std::size_t number) {
  const std::vector<std::string_view> fields = split(line, ',');
  if (fields.size() != 4)
    throw FileProblem("line {} has {} fields, not the four of {}", number, fields.size(), kHeader);
  const auto stamp = parse_stamp(fields[0]);
  const auto x = parse_number(fields[1]);
  const auto y = parse_number(fields[2]);
  const auto yaw = parse_number(fields[3]);
  if (!stamp || !x || !y || !yaw)
    throw FileProblem("line {} holds something other than four finite numbers", number);
  return {*stamp, Pose2::from({*x, *y}, *yaw)};
}

std::vector<PoseReading> parse_truth(std::string_view text) {
  const std::vector<std::string_view> lines = lines_of(text);
  if (lines.empty() || lines.front() != kHeader)
    throw FileProblem("line 1 is not '{}'; true poses are expected in s, m, m, rad", kHeader);
  std::vector<PoseReading> poses;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    poses.push_back(parse_row(lines[i], i + 1));
    if (poses.size() > 1 && poses.back().stamp < poses[poses.size() - 2].stamp)
      throw FileProblem("line {} goes back in time; sort the rows by t", i + 1);
  }
  if (poses.empty()) throw FileProblem("it has no row of poses");
  return poses;
}

}  // namespace

Result<void> write_truth(const std::vector<PoseReading>& poses, const std::filesystem::path& file) {
  std::string text(kHeader);
  text += '\n';
  for (const PoseReading& pose : poses) {
    const Pose2& p = pose.map_T_base;
    if (!p.is_finite())
      return Error(fmt::format("cannot write {}: the pose at {} s is not finite", file.string(),
                               pose.stamp.seconds()));
    text += fmt::format("{},{},{},{}\n", to_text(pose.stamp), to_text(p.x), to_text(p.y), to_text(p.yaw));
  }
  return write_file(file, text);
}

Result<std::vector<PoseReading>> read_truth(const std::filesystem::path& file) {
  const Result<std::string> text = read_file(file, kMaxTruthBytes);
  if (!text) return text.error();
  return guarded(file, [&] { return parse_truth(*text); });
}

}  // namespace mstsl::io
