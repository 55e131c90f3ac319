#include "processes.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace mstsl::app {

int launched_processes() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"}) {
    const char* value = std::getenv(name);
    if (value == nullptr) continue;
    const std::string_view text(value);
    int size = 1;
    if (std::from_chars(text.data(), text.data() + text.size(), size).ec == std::errc() && size > 1)
      return size;
  }
  return 1;
}

}  // namespace mstsl::app
