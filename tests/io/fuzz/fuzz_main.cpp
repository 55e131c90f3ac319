#include <cstddef>
#include <cstdint>
#include <span>

#include "targets.hpp"

/// MSTSL_FUZZ_TARGET is one function of targets.hpp; each program has its own.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mstsl::test::MSTSL_FUZZ_TARGET(std::as_bytes(std::span(data, size)));
  return 0;
}
