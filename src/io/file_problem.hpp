#pragma once

#include <filesystem>
#include <new>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "mstsl/core/result.hpp"

namespace mstsl::io {

/// What is wrong inside a file. Private to this module: parsers throw it, and `guarded` makes it an Error at
/// the edge.
struct FileProblem : std::runtime_error {
  template <typename... Args>
  explicit FileProblem(fmt::format_string<Args...> format, Args&&... args)
      : std::runtime_error(fmt::format(format, std::forward<Args>(args)...)) {}
};

/// The value of `parse()`, or the problem it threw as an Error that begins with the file's name.
template <typename Parse>
auto guarded(const std::filesystem::path& file, Parse&& parse) -> Result<decltype(parse())> {
  try {
    return parse();
  } catch (const FileProblem& problem) {
    return Error(fmt::format("{}: {}", file.string(), problem.what()));
  } catch (const std::bad_alloc&) {
    return Error(fmt::format("{}: it needs more memory than this machine gives", file.string()));
  } catch (const std::length_error&) {
    return Error(fmt::format("{}: it needs more memory than this machine gives", file.string()));
  }
}

}  // namespace mstsl::io
