#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The little of the NetCDF-4 C library that field maps need. Everything throws FileProblem. Files are made
/// in a scratch file and read from memory, so that the library neither locks nor half-writes the user's file.
namespace mstsl::io {

/// Held while a NetcdfWriter or NetcdfReader lives: the C library may be entered by one thread at a time.
class NetcdfLock {
 public:
  NetcdfLock();

 private:
  std::unique_lock<std::mutex> lock_;
};

/// A file of the system's folder for temporary files, gone with the object.
class ScratchFile {
 public:
  ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

class NetcdfWriter {
 public:
  NetcdfWriter();
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;
  ~NetcdfWriter();

  /// Adds a dimension; expects length > 0 (NetCDF reads 0 as "unlimited").
  int dimension(const char* name, std::size_t length);
  /// Adds a compressed variable; float variables have NaN as their fill value.
  int variable(const char* name, const std::vector<int>& dimensions, const std::vector<float>& values);
  int variable(const char* name, const std::vector<int>& dimensions, const std::vector<double>& values);
  int variable(const char* name, const std::vector<int>& dimensions, const std::vector<std::uint8_t>& values);
  int variable(const char* name, const std::vector<int>& dimensions, const std::vector<std::int32_t>& values);
  int variable(const char* name, const std::vector<int>& dimensions, const std::vector<std::int64_t>& values);

  void attribute(int variable, const char* name, std::string_view text);
  void attribute(int variable, const char* name, double value);
  void attribute(int variable, const char* name, const std::vector<std::uint8_t>& values);
  void attribute(int variable, const char* name, const std::vector<std::string>& texts);

  /// The finished file; nothing may follow.
  std::string finish();

 private:
  int define(const char* name, int type, const std::vector<int>& dimensions);
  ScratchFile scratch_;
  NetcdfLock lock_;
  int id_ = -1;
};

class NetcdfReader {
 public:
  /// `bytes` must outlive the reader.
  explicit NetcdfReader(std::string_view bytes);
  NetcdfReader(const NetcdfReader&) = delete;
  NetcdfReader& operator=(const NetcdfReader&) = delete;
  ~NetcdfReader();

  std::optional<std::size_t> dimension(const char* name) const;

  /// All values of a variable over exactly these dimensions, in this order, in this unit ("" for none).
  std::vector<float> floats(const char* name, const std::vector<const char*>& dimensions,
                            std::string_view unit) const;
  std::vector<double> doubles(const char* name, const std::vector<const char*>& dimensions,
                              std::string_view unit) const;
  std::vector<std::uint8_t> bytes(const char* name, const std::vector<const char*>& dimensions) const;
  std::vector<std::int64_t> integers(const char* name, const std::vector<const char*>& dimensions) const;
  bool has_variable(const char* name) const;

  /// Global attributes.
  std::string text(const char* name) const;
  double number(const char* name) const;
  std::vector<std::string> texts(const char* name) const;  ///< none where the attribute is absent
  /// Every number whose name begins with `prefix`, by the rest of its name.
  std::map<std::string, double> numbers(std::string_view prefix) const;

 private:
  enum class Kind { kReal, kByte, kInteger };
  struct Variable {
    int id;
    std::size_t length;
  };
  static bool is_of(Kind kind, int type);
  Variable find(const char* name, const std::vector<const char*>& dimensions, Kind kind) const;
  void expect_unit(const char* name, int variable, std::string_view unit) const;
  std::vector<std::string> texts(int variable, const char* name) const;

  NetcdfLock lock_;
  int id_ = -1;
};

}  // namespace mstsl::io
