#pragma once

#include <string>
#include <string_view>

namespace mstsl::io {

/// The bytes with a line after them that holds their CRC-32. HDF5 looks at nothing behind its own end of
/// file, and drops the line when another program changes the file.
std::string sealed(std::string bytes);

/// Throws FileProblem for bytes that changed since they were sealed; bytes without a seal pass. HDF5 must not
/// see damaged files: it has been seen to take memory without end on a single flipped bit.
void check_seal(std::string_view bytes);

}  // namespace mstsl::io
