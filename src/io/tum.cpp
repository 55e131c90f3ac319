#include "mstsl/io/tum.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "mstsl/io/file_bytes.hpp"

#include "file_problem.hpp"
#include "text_numbers.hpp"

namespace mstsl::io {
namespace {

constexpr std::size_t kMaxTumBytes = std::size_t{1} << 32;

PoseReading parse_row(const std::vector<std::string_view>& fields, std::size_t number) {
  if (fields.size() != 8)
    throw FileProblem("line {} has {} fields, not the eight of 't x y z qx qy qz qw'", number, fields.size());
  std::array<double, 7> v{};
  const auto stamp = parse_stamp(fields[0]);
  bool good = stamp.has_value();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto value = parse_number(fields[i + 1]);
    good = good && value;
    v[i] = value.value_or(0.0);
  }
  if (!good) throw FileProblem("line {} holds something other than eight finite numbers", number);
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (!(std::abs(q.norm() - 1.0) < 0.01))
    throw FileProblem("line {} has a quaternion of length {}, not 1", number, q.norm());
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = q.normalized().toRotationMatrix();
  motion.translation() << v[0], v[1], v[2];
  return {*stamp, to_pose2(motion)};
}

std::vector<PoseReading> parse_tum(std::string_view text) {
  std::vector<PoseReading> poses;
  const std::vector<std::string_view> lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<std::string_view> fields = split(lines[i], ' ');
    if (!fields.empty() && !fields.front().starts_with('#')) poses.push_back(parse_row(fields, i + 1));
  }
  return poses;
}

}  // namespace

Result<TumWriter> TumWriter::open(const std::filesystem::path& file) {
  Result<AtomicFile> opened = AtomicFile::open(file, IfDropped::kKeepPart);
  if (!opened) return opened.error();
  return TumWriter(*std::move(opened));
}

Result<void> TumWriter::write(const PoseReading& pose) {
  const Pose2& p = pose.map_T_base;
  if (!p.is_finite())
    return Error(fmt::format("cannot write {}: the pose at {} s is not finite", file_.target().string(),
                             pose.stamp.seconds()));
  const Result<void> written =
      file_.write(fmt::format("{} {} {} 0 0 0 {} {}\n", to_text(pose.stamp), to_text(p.x), to_text(p.y),
                              to_text(std::sin(p.yaw / 2.0)), to_text(std::cos(p.yaw / 2.0))));
  return written ? file_.flush() : written;
}

Result<void> TumWriter::close() { return file_.close(); }

Result<std::vector<PoseReading>> read_tum(const std::filesystem::path& file) {
  const Result<std::string> text = read_file(file, kMaxTumBytes);
  if (!text) return text.error();
  return guarded(file, [&] { return parse_tum(*text); });
}

}  // namespace mstsl::io
