#include "piece_store.hpp"

#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace mstsl {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Each process writes its own file: two writers of one may tear each other's lines where the folder is
/// shared.
std::string file_name(int rank) { return rank == 0 ? "runs.jsonl" : fmt::format("runs.{}.jsonl", rank); }

bool is_kept(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with("runs.") && name.ends_with("jsonl");
}

std::optional<std::string> word(const Json& piece, const char* key) {
  const auto found = piece.find(key);
  if (found == piece.end() || !found->is_string()) return std::nullopt;
  return found->get<std::string>();
}

bool ends_within_a_line(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file || file.tellg() <= 0) return false;
  file.seekg(-1, std::ios::end);
  return file.get() != '\n';
}

}  // namespace

Result<PieceStore> PieceStore::open(const fs::path& folder, Origin origin, const Crew& crew) {
  PieceStore store;
  store.origin_ = std::move(origin);
  const auto begin = [&]() -> Result<std::string> {
    if (folder.empty()) return std::string("{}");
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return Error(fmt::format("{}: cannot make the folder: {}", folder.string(), error.message()));
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (is_kept(entry.path())) store.read(entry.path());
    store.path_ = folder / file_name(crew.rank);
    const bool torn = ends_within_a_line(store.path_);
    store.file_.open(store.path_, std::ios::app);
    if (torn) store.file_ << '\n';
    if (!store.file_.good())
      return Error(fmt::format("{}: cannot be written; choose another folder", store.path_.string()));
    return Json(store.pieces_).dump();
  };
  const auto all = pooled(crew, begin());
  if (!all) return all.error();
  for (const std::string& one : *all) store.pieces_.merge(Json::parse(one).get<Pieces>());
  return store;
}

void PieceStore::read(const fs::path& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const Json piece = Json::parse(line, nullptr, false);
    if (!piece.is_object() || !piece.contains("made") || word(piece, "options") != origin_.options ||
        word(piece, "build") != origin_.build)
      continue;
    if (const auto name = word(piece, "piece")) pieces_.insert_or_assign(*name, piece["made"].dump());
  }
}

const std::string* PieceStore::find(const std::string& name) const {
  const auto found = pieces_.find(name);
  return found == pieces_.end() ? nullptr : &found->second;
}

void PieceStore::add(const std::string& name, const std::string& content) {
  write(name, content);
  pieces_.insert_or_assign(name, content);
  added_.push_back(name);
}

void PieceStore::write(const std::string& name, const std::string& content) {
  if (path_.empty()) return;
  file_ << R"({"piece":)" << Json(name).dump() << R"(,"options":)" << Json(origin_.options).dump()
        << R"(,"build":)" << Json(origin_.build).dump() << R"(,"made":)" << content << "}\n"
        << std::flush;
}

Result<void> PieceStore::gather(const Crew& crew, const Result<void>& mine) {
  Pieces news;
  for (const std::string& name : added_) news.emplace(name, pieces_.at(name));
  const auto all = pooled(crew, mine ? Result<std::string>(Json(news).dump()) : mine.error());
  if (!all) return all.error();
  for (std::size_t rank = 0; rank < all->size(); ++rank) {
    if (rank == static_cast<std::size_t>(crew.rank)) continue;
    for (auto& [name, content] : Json::parse((*all)[rank]).get<Pieces>()) {
      if (crew.leads()) write(name, content);
      pieces_.insert_or_assign(name, std::move(content));
    }
  }
  if (!good()) return Error(fmt::format("{}: cannot be written; is the disk full?", path_.string()));
  return {};
}

}  // namespace mstsl
