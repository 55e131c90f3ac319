#pragma once

#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/eval/hard_record.hpp"

namespace mstsl {

/// The runs of one folder: one line each, added as they finish, read again when the protocol goes on.
class HardStore {
 public:
  /// Takes the lines that were made with these options by this build; a line cut off by an interruption and
  /// those of other options or builds are passed over. Errors: a folder that cannot be made or written.
  static Result<HardStore> open(const std::filesystem::path& folder, const std::string& options,
                                const std::string& build);

  const HardRecord* find(const HardKey& key) const;
  /// Keeps a record and writes it; options and build are filled in. Not to be called by two threads at once.
  void add(HardRecord record);
  bool good() const { return file_.good(); }

 private:
  std::vector<HardRecord> records_;
  std::string options_, build_;
  std::ofstream file_;
};

}  // namespace mstsl
