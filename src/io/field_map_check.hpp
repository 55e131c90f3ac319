#pragma once

#include "mstsl/magnetic/field_map.hpp"

namespace mstsl::io {

/// The law that every field map in a file obeys, asked by the writer and the reader alike; throws
/// FileProblem. A grid of a sensible size; for each cell either six finite numbers, no variance negative, or
/// no number and no support.
void check_field_map(const FieldMap& map);

/// The part of it that must hold before memory is taken.
void check_geometry(const GridGeometry& geometry);

}  // namespace mstsl::io
