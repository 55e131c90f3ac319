#include "seal.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include "file_problem.hpp"

namespace mstsl::io {
namespace {

constexpr std::string_view kMark = "\nmstsl crc32 ";
constexpr std::size_t kSealBytes = kMark.size() + 8 + 1;  // eight hexadecimal digits and a line feed

std::string seal_of(std::string_view bytes) {
  const auto crc =
      crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  return fmt::format("{}{:08x}\n", kMark, crc);
}

}  // namespace

std::string sealed(std::string bytes) { return bytes += seal_of(bytes); }

void check_seal(std::string_view bytes) {
  if (bytes.size() < kSealBytes) return;
  const std::string_view seal = bytes.substr(bytes.size() - kSealBytes);
  if (seal.starts_with(kMark) && seal != seal_of(bytes.substr(0, bytes.size() - kSealBytes)))
    throw FileProblem("the file is damaged: its checksum does not fit; copy it anew from where it was made");
}

}  // namespace mstsl::io
