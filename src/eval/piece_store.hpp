#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "mstsl/core/crew.hpp"
#include "mstsl/core/result.hpp"

namespace mstsl {

/// Pieces of work that are finished, by name: one line of JSON each in a folder, added as they finish, read
/// again when the work goes on, and shared among the processes that work together.
class PieceStore {
 public:
  /// What decides the pieces besides their names. Those of another program or with other options are not
  /// taken.
  struct Origin {
    std::string options, build;
  };

  /// All that any process of the crew kept before, whether they share the folder or each has its own; lines
  /// cut off by an interruption are passed over. Without a folder nothing outlives the store. Errors: a
  /// folder that cannot be made or written, by any of them.
  static Result<PieceStore> open(const std::filesystem::path& folder, Origin origin, const Crew& crew = {});

  /// The piece's content, or null where it is not there.
  const std::string* find(const std::string& name) const;
  /// Keeps a piece and writes it; `content` is JSON in one line. Not to be called by two threads at once.
  void add(const std::string& name, const std::string& content);
  /// Whether pieces outlive the store.
  bool keeps() const { return !path_.empty(); }
  /// Whether all could be written.
  bool good() const { return path_.empty() || file_.good(); }

  /// At the end of the work, with what came of it here: every process has all pieces then, and the leader's
  /// file too. Errors: the first of any process.
  Result<void> gather(const Crew& crew, const Result<void>& mine);

 private:
  using Pieces = std::map<std::string, std::string>;
  void read(const std::filesystem::path& path);
  void write(const std::string& name, const std::string& content);

  Origin origin_;
  std::filesystem::path path_;  ///< of this process's file; none without a folder
  Pieces pieces_;
  std::vector<std::string> added_;  ///< by this process, in order
  std::ofstream file_;
};

}  // namespace mstsl
