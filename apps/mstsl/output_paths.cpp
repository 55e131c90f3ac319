#include "output_paths.hpp"

#include <system_error>

#include <fmt/format.h>

namespace mstsl::app {

namespace fs = std::filesystem;

std::optional<Error> overwritten_input(const std::vector<fs::path>& outputs,
                                       const std::vector<fs::path>& inputs) {
  for (const fs::path& output : outputs)
    for (const fs::path& input : inputs) {
      std::error_code ignored;  // an input that is absent is complained of where it is read
      if (fs::is_regular_file(output, ignored) && fs::equivalent(output, input, ignored))
        return Error(fmt::format("{} is an input and would be overwritten; give the output another name",
                                 output.string()));
    }
  return std::nullopt;
}

}  // namespace mstsl::app
