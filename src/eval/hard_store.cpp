#include "hard_store.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace mstsl {

namespace fs = std::filesystem;

Result<HardStore> HardStore::open(const fs::path& folder, const std::string& options,
                                  const std::string& build) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
  HardStore store;
  store.options_ = options;
  store.build_ = build;
  const fs::path path = folder / "runs.jsonl";
  bool whole = true;
  if (std::ifstream kept(path); kept) {
    for (std::string line; std::getline(kept, line);) {
      whole = !kept.eof();
      Result<HardRecord> record = record_from_line(line);
      if (record && record->options == options && record->build == build)
        store.records_.push_back(std::move(record).value());
    }
  }
  store.file_.open(path, std::ios::app);
  if (!whole) store.file_ << '\n';
  if (!store.file_.good())
    return Error(fmt::format("{}: cannot be written; choose another folder", path.string()));
  return store;
}

const HardRecord* HardStore::find(const HardKey& key) const {
  const auto found = std::find_if(records_.begin(), records_.end(),
                                  [&](const HardRecord& record) { return record.key == key; });
  return found == records_.end() ? nullptr : &*found;
}

void HardStore::add(HardRecord record) {
  record.options = options_;
  record.build = build_;
  file_ << to_line(record) << '\n' << std::flush;
  records_.push_back(std::move(record));
}

}  // namespace mstsl
