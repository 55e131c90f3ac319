#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "mstsl/core/result.hpp"

namespace mstsl::datasets {

/// The named columns of a CSV file of numbers, in the order of `names`, each with one finite number a row.
/// The first line names the columns, with or without a leading '#'; blanks around names and numbers, lines
/// without anything and columns not asked for are passed over. Errors, with the line: a column that is not
/// there (the message lists those that are), a row with more or fewer fields than names, a field that is no
/// finite number, a file without a row.
Result<std::vector<std::vector<double>>> read_number_columns(const std::filesystem::path& file,
                                                             std::span<const std::string_view> names);

/// The same from a file whose first line is a row already: `width` columns, all of them.
Result<std::vector<std::vector<double>>> read_number_rows(const std::filesystem::path& file,
                                                          std::size_t width);

}  // namespace mstsl::datasets
