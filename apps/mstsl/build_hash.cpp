#include "build_hash.hpp"

#include <cstdint>
#include <fstream>
#include <vector>

#include <fmt/format.h>

namespace mstsl::app {

std::string build_hash() {  // FNV-1a
  std::ifstream self("/proc/self/exe", std::ios::binary);
  std::uint64_t hash = 14695981039346656037u;
  std::vector<char> block(1 << 16);
  while (self.read(block.data(), static_cast<std::streamsize>(block.size())) || self.gcount() > 0)
    for (std::streamsize i = 0; i < self.gcount(); ++i)
      hash = (hash ^ static_cast<unsigned char>(block[static_cast<std::size_t>(i)])) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

}  // namespace mstsl::app
