#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include <hdf5.h>
#include <netcdf.h>
#include <unistd.h>

#include "mstsl/io/file_bytes.hpp"

#include "file_problem.hpp"
#include "netcdf_file.hpp"

namespace mstsl::io {
namespace {

void check(int status) {
  if (status != NC_NOERR)
    throw FileProblem("NetCDF cannot make it ({}); is the folder for temporary files full?",
                      nc_strerror(status));
}

std::mutex& library_mutex() {
  static std::mutex mutex;  // guards the C library's own global state
  return mutex;
}

}  // namespace

NetcdfLock::NetcdfLock() : lock_(library_mutex()) {
  H5Eset_auto2(H5E_DEFAULT, nullptr,
               nullptr);  // NetCDF silences HDF5 too, but only for the thread that came first
}

ScratchFile::ScratchFile() {
  std::error_code ignored;
  name_ = (std::filesystem::temp_directory_path(ignored) / "mstsl-XXXXXX").string();
  const int descriptor = mkstemp(name_.data());
  if (descriptor < 0)
    throw FileProblem("no temporary file can be made as {}: {}; set TMPDIR to a folder that you may write to",
                      name_, std::generic_category().message(errno));
  ::close(descriptor);
}

ScratchFile::~ScratchFile() { unlink(name_.c_str()); }

// Not nc_create_mem(): what it makes does not track the order of its parts, and no program can open it for
// writing.
NetcdfWriter::NetcdfWriter() { check(nc_create(scratch_.name().c_str(), NC_NETCDF4 | NC_CLOBBER, &id_)); }

NetcdfWriter::~NetcdfWriter() {
  if (id_ >= 0) nc_abort(id_);
}

int NetcdfWriter::dimension(const char* name, std::size_t length) {
  int dimension = -1;
  check(nc_def_dim(id_, name, length, &dimension));
  return dimension;
}

int NetcdfWriter::define(const char* name, int type, const std::vector<int>& dimensions) {
  constexpr int kDeflateLevel = 4;  // higher levels save under 2 % more here and take twice the time
  int variable = -1;
  check(nc_def_var(id_, name, type, static_cast<int>(dimensions.size()), dimensions.data(), &variable));
  check(nc_def_var_deflate(id_, variable, NC_SHUFFLE, 1, kDeflateLevel));
  return variable;
}

int NetcdfWriter::variable(const char* name, const std::vector<int>& dimensions,
                           const std::vector<float>& values) {
  const int variable = define(name, NC_FLOAT, dimensions);
  const float fill = std::numeric_limits<float>::quiet_NaN();
  check(nc_def_var_fill(id_, variable, NC_FILL, &fill));
  check(nc_put_var_float(id_, variable, values.data()));
  return variable;
}

int NetcdfWriter::variable(const char* name, const std::vector<int>& dimensions,
                           const std::vector<double>& values) {
  const int variable = define(name, NC_DOUBLE, dimensions);
  check(nc_put_var_double(id_, variable, values.data()));
  return variable;
}

int NetcdfWriter::variable(const char* name, const std::vector<int>& dimensions,
                           const std::vector<std::uint8_t>& values) {
  const int variable = define(name, NC_BYTE, dimensions);
  check(nc_put_var_uchar(id_, variable, values.data()));
  return variable;
}

int NetcdfWriter::variable(const char* name, const std::vector<int>& dimensions,
                           const std::vector<std::int32_t>& values) {
  const int variable = define(name, NC_INT, dimensions);
  check(nc_put_var_int(id_, variable, values.data()));
  return variable;
}

int NetcdfWriter::variable(const char* name, const std::vector<int>& dimensions,
                           const std::vector<std::int64_t>& values) {
  static_assert(sizeof(long long) == sizeof(std::int64_t));
  const std::vector<long long> copy(values.begin(), values.end());
  const int variable = define(name, NC_INT64, dimensions);
  check(nc_put_var_longlong(id_, variable, copy.data()));
  return variable;
}

void NetcdfWriter::attribute(int variable, const char* name, std::string_view text) {
  check(nc_put_att_text(id_, variable, name, text.size(), text.data()));
}

void NetcdfWriter::attribute(int variable, const char* name, double value) {
  check(nc_put_att_double(id_, variable, name, NC_DOUBLE, 1, &value));
}

void NetcdfWriter::attribute(int variable, const char* name, const std::vector<std::uint8_t>& values) {
  check(nc_put_att_uchar(id_, variable, name, NC_BYTE, values.size(), values.data()));
}

void NetcdfWriter::attribute(int variable, const char* name, const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  check(nc_put_att_string(id_, variable, name, pointers.size(), pointers.data()));
}

std::string NetcdfWriter::finish() {
  check(nc_close(std::exchange(id_, -1)));
  Result<std::string> bytes = read_file(scratch_.name(), std::numeric_limits<std::size_t>::max());
  if (!bytes) throw FileProblem("{}", bytes.error().message());
  return *std::move(bytes);
}

}  // namespace mstsl::io
