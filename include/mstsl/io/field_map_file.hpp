#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mstsl/core/result.hpp"
#include "mstsl/magnetic/field_map.hpp"

namespace mstsl::io {

/// Writes a field map as one NetCDF-4 file after the CF conventions 1.8, atomically; the same map gives the
/// same bytes.
///
/// Coordinates x, y (m): cell centres in the map frame, or, where the grid is turned, in the grid's own frame
/// (its pose is in the attributes grid_origin_x_m, grid_origin_y_m, grid_yaw_rad). Variables over (y, x): bx,
/// by, bz (uT), bx_variance, by_variance, bz_variance (uT2), NaN where unknown, and supported (0 or 1); over
/// (fingerprint): fp_x, fp_y (m), fp_bx, fp_by, fp_bz (uT). Where the map knows its drives, also: over
/// (drive): drive_begin, drive_end (nanoseconds since 1970), their logs in the attribute drives; fp_heading
/// (rad), fp_drive (index of the drive); over (y, x) newest_drive, which came near last (-1: none); the same
/// columns as replaced_fp_* for fingerprints that an update took out, with replaced_fp_by_drive. Global
/// attributes: model, height_m, resolution_m, hyperparameter_NAME for each hyper-parameter, provenance.
///
/// Errors: a full disk; a map that read_field_map() would refuse (sizes that do not fit, half-finite cells,
/// ...).
Result<void> write_field_map(const FieldMap& map, const std::filesystem::path& file);

/// Reads what write_field_map() writes, also after xarray or nco went over it. Every dimension, type, unit
/// and value is checked. Errors: a file that is absent, no NetCDF, cut off, lacks a variable, or has it in
/// other units.
Result<FieldMap> read_field_map(const std::filesystem::path& file);

/// The same from and to memory; `name` stands for the file in errors.
Result<std::string> encode_field_map(const FieldMap& map, const std::filesystem::path& name);
Result<FieldMap> decode_field_map(std::string_view bytes, const std::filesystem::path& name);

}  // namespace mstsl::io
