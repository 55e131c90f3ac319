#include "info.hpp"

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "mstsl/io/recording_info.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;

/// The first bytes, by which most kinds tell themselves apart.
std::string beginning(const fs::path& file) {
  std::string bytes(512, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

bool is_image(const std::string& head) {
  return head.starts_with("P2") || head.starts_with("P5") || head.starts_with("\x89PNG") ||
         head.starts_with("BM");
}

Result<Description> describe(const fs::path& file, const Session& session) {
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    return Error(fmt::format("cannot read {}: there is no such file", file.string()));
  const std::string head = beginning(file);
  if (head.starts_with("\x89HDF") || head.starts_with("CDF")) return describe_field(file);
  if (head.starts_with("{")) return describe_estimates(file);
  if (head.starts_with("t,x,y,yaw")) return describe_truth(file);
  if (is_image(head))
    return Error(fmt::format("{}: this is a map's image; ask about the yaml beside it", file.string()));
  if (io::is_recording(file)) return describe_log(file, session);
  if (head.find("image:") != std::string::npos) return describe_map(file);
  return Error(fmt::format(
      "{}: this is no map (yaml), field map (NetCDF), log (MCAP, rosbag2 folder, ROS 1 bag, CARMEN), "
      "estimates (JSON Lines) or table of true poses",
      file.string()));
}

Result<Exit> print_info(const fs::path& file, const Session& session) {
  const Result<Description> description = describe(file, session);
  if (!description) return description.error();
  const auto replace = Description::error_handler_t::replace;  // file names need not be UTF-8
  fmt::print("{}", session.json ? description->dump(2, ' ', false, replace) + "\n" : to_text(*description));
  return Exit::kDone;
}

}  // namespace

void add_info(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand("info", "Tell what is in a map, field map, log or estimates file");
  add_common_options(command, session);
  const auto file = std::make_shared<std::string>();
  command.add_option("FILE", *file, "The file, or a rosbag2 folder; its kind is seen from its content")
      ->required();
  command.callback(
      [file, &session] { session.work = [file, &session] { return print_info(*file, session); }; });
}

}  // namespace mstsl::app
