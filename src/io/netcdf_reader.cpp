#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <netcdf.h>
#include <netcdf_mem.h>

#include "file_problem.hpp"
#include "netcdf_file.hpp"

namespace mstsl::io {
namespace {

/// More than any attribute of ours; a damaged length is not believed.
constexpr std::size_t kMaxAttribute = 1 << 24;

void check(int status, std::string_view what) {
  if (status == NC_NOERR) return;
  throw FileProblem("the NetCDF file is damaged: {} cannot be read ({})", what, nc_strerror(status));
}

}  // namespace

NetcdfReader::NetcdfReader(std::string_view bytes) {
  // The library only reads through the pointer in this mode; its signature lacks the const.
  const int status = nc_open_mem("memory", NC_NOWRITE, bytes.size(), const_cast<char*>(bytes.data()), &id_);
  if (status == NC_NOERR) return;
  if (status == NC_ENOTNC || bytes.size() < 8)
    throw FileProblem("this is no NetCDF file; make one with `mstsl map magnetic`");
  throw FileProblem("the NetCDF file is damaged or cut off ({})", nc_strerror(status));
}

NetcdfReader::~NetcdfReader() { nc_close(id_); }

std::optional<std::size_t> NetcdfReader::dimension(const char* name) const {
  int dimension = -1;
  std::size_t length = 0;
  if (nc_inq_dimid(id_, name, &dimension) != NC_NOERR) return std::nullopt;
  check(nc_inq_dimlen(id_, dimension, &length), name);
  return length;
}

bool NetcdfReader::is_of(Kind kind, int type) {
  const bool is_byte = type == NC_BYTE || type == NC_UBYTE;
  switch (kind) {
    case Kind::kReal:
      return type == NC_FLOAT || type == NC_DOUBLE;
    case Kind::kByte:
      return is_byte;
    case Kind::kInteger:
      return is_byte || type == NC_SHORT || type == NC_INT || type == NC_INT64;
  }
  return false;
}

NetcdfReader::Variable NetcdfReader::find(const char* name, const std::vector<const char*>& dimensions,
                                          Kind kind) const {
  int variable = -1;
  if (nc_inq_varid(id_, name, &variable) != NC_NOERR)
    throw FileProblem("the variable '{}' is missing; is this a field map made by `mstsl map magnetic`?",
                      name);
  nc_type type = NC_NAT;
  int rank = 0;
  std::array<int, NC_MAX_VAR_DIMS> ids{};
  check(nc_inq_var(id_, variable, nullptr, &type, &rank, ids.data(), nullptr), name);
  if (!is_of(kind, type))
    throw FileProblem("the variable '{}' is not of type {}", name,
                      kind == Kind::kReal   ? "float or double"
                      : kind == Kind::kByte ? "byte"
                                            : "integer");
  bool fits = rank == static_cast<int>(dimensions.size());
  std::size_t length = 1;
  for (std::size_t i = 0; fits && i < dimensions.size(); ++i) {
    int wanted = -1;
    fits = nc_inq_dimid(id_, dimensions[i], &wanted) == NC_NOERR && wanted == ids[i];
    length *= dimension(dimensions[i]).value_or(0);
  }
  if (!fits)
    throw FileProblem("the variable '{}' does not have the dimensions ({})", name,
                      fmt::join(dimensions, ", "));
  return {variable, length};
}

void NetcdfReader::expect_unit(const char* name, int variable, std::string_view unit) const {
  const std::vector<std::string> found = texts(variable, "units");
  if (found.size() == 1 && found.front() == unit) return;
  if (found.empty()) throw FileProblem("the variable '{}' has no units; {} are needed", name, unit);
  throw FileProblem("the variable '{}' is in '{}'; {} are needed: convert it", name, found.front(), unit);
}

std::vector<float> NetcdfReader::floats(const char* name, const std::vector<const char*>& dimensions,
                                        std::string_view unit) const {
  const Variable variable = find(name, dimensions, Kind::kReal);
  expect_unit(name, variable.id, unit);
  std::vector<float> values(variable.length);
  check(nc_get_var_float(id_, variable.id, values.data()), name);
  return values;
}

std::vector<double> NetcdfReader::doubles(const char* name, const std::vector<const char*>& dimensions,
                                          std::string_view unit) const {
  const Variable variable = find(name, dimensions, Kind::kReal);
  expect_unit(name, variable.id, unit);
  std::vector<double> values(variable.length);
  check(nc_get_var_double(id_, variable.id, values.data()), name);
  return values;
}

std::vector<std::uint8_t> NetcdfReader::bytes(const char* name,
                                              const std::vector<const char*>& dimensions) const {
  const Variable variable = find(name, dimensions, Kind::kByte);
  std::vector<std::uint8_t> values(variable.length);
  check(nc_get_var_uchar(id_, variable.id, values.data()), name);
  return values;
}

std::vector<std::int64_t> NetcdfReader::integers(const char* name,
                                                 const std::vector<const char*>& dimensions) const {
  const Variable variable = find(name, dimensions, Kind::kInteger);
  std::vector<long long> values(variable.length);
  check(nc_get_var_longlong(id_, variable.id, values.data()), name);
  return {values.begin(), values.end()};
}

bool NetcdfReader::has_variable(const char* name) const {
  int variable = -1;
  return nc_inq_varid(id_, name, &variable) == NC_NOERR;
}

std::string NetcdfReader::text(const char* name) const {
  const std::vector<std::string> found = texts(NC_GLOBAL, name);
  if (found.size() != 1) throw FileProblem("the global attribute '{}' is missing or no text", name);
  return found.front();
}

double NetcdfReader::number(const char* name) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  double value = 0.0;
  if (nc_inq_att(id_, NC_GLOBAL, name, &type, &length) != NC_NOERR || length != 1 || type == NC_CHAR ||
      nc_get_att_double(id_, NC_GLOBAL, name, &value) != NC_NOERR)
    throw FileProblem("the global attribute '{}' is missing or no number", name);
  return value;
}

std::vector<std::string> NetcdfReader::texts(const char* name) const { return texts(NC_GLOBAL, name); }

std::vector<std::string> NetcdfReader::texts(int variable, const char* name) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(id_, variable, name, &type, &length) != NC_NOERR) return {};
  if (length > kMaxAttribute)
    throw FileProblem("the NetCDF file is damaged: the attribute '{}' claims {} items", name, length);
  if (type == NC_CHAR) {
    std::string text(length, '\0');
    check(nc_get_att_text(id_, variable, name, text.data()), name);
    return {text};
  }
  if (type != NC_STRING) throw FileProblem("the attribute '{}' is no text", name);
  std::vector<char*> pointers(length, nullptr);
  check(nc_get_att_string(id_, variable, name, pointers.data()), name);
  std::vector<std::string> found;
  for (const char* text : pointers) found.emplace_back(text != nullptr ? text : "");
  nc_free_string(length, pointers.data());
  return found;
}

std::map<std::string, double> NetcdfReader::numbers(std::string_view prefix) const {
  int count = 0;
  check(nc_inq_natts(id_, &count), "the list of attributes");
  std::map<std::string, double> found;
  for (int i = 0; i < count; ++i) {
    std::array<char, NC_MAX_NAME + 1> name{};
    check(nc_inq_attname(id_, NC_GLOBAL, i, name.data()), "an attribute's name");
    const std::string_view whole(name.data());
    if (whole.starts_with(prefix)) found.emplace(whole.substr(prefix.size()), number(name.data()));
  }
  return found;
}

}  // namespace mstsl::io
