#include "eval/piece_store.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "test_support.hpp"
#include "thread_crew.hpp"

namespace mstsl {
namespace {

using test::must;

const PieceStore::Origin kOrigin{"seed 1 \"quoted\"", "build"};

std::size_t lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::size_t count = 0;
  for (std::string line; std::getline(file, line);) ++count;
  return count;
}

TEST(PieceStore, KeepsPiecesOfTheSameOrigin) {
  const test::TemporaryFolder folder;
  must(PieceStore::open(folder.path(), kOrigin)).add("a 1", R"({"x":0.1})");
  {  // cut off within a line
    std::ofstream(folder.path() / "runs.jsonl", std::ios::app) << R"({"piece":"b","options":"se)";
  }
  {
    PieceStore store = must(PieceStore::open(folder.path(), kOrigin));
    ASSERT_NE(store.find("a 1"), nullptr);
    EXPECT_EQ(*store.find("a 1"), R"({"x":0.1})");
    EXPECT_EQ(store.find("b"), nullptr);
    store.add("b", "[1,2]");
    EXPECT_TRUE(store.good());
  }
  EXPECT_EQ(*must(PieceStore::open(folder.path(), kOrigin)).find("b"), "[1,2]");
  EXPECT_EQ(must(PieceStore::open(folder.path(), {kOrigin.options, "other"})).find("b"), nullptr);
  EXPECT_EQ(must(PieceStore::open(folder.path(), {"seed 2", kOrigin.build})).find("b"), nullptr);
}

TEST(PieceStore, PassesOverWhatIsNoPiece) {
  const test::TemporaryFolder folder;
  {
    std::ofstream file(folder.path() / "runs.jsonl");
    file << "\n[]\n3\nnull\n{\"made\":1}\n{\"piece\":7,\"made\":1}\n{\"options\":[],\"made\":{}}\n\xff\xfe\n";
  }
  PieceStore store = must(PieceStore::open(folder.path(), kOrigin));
  store.add("a", "1");
  EXPECT_NE(must(PieceStore::open(folder.path(), kOrigin)).find("a"), nullptr);
}

TEST(PieceStore, ProcessesShareAFolderOrHaveTheirOwn) {
  for (const bool in_common : {true, false}) {
    const test::TemporaryFolder folder;
    const auto folder_of = [&](int rank) {
      return in_common ? folder.path() : folder.path() / std::to_string(rank);
    };
    test::as_crew(3, [&](const Crew& crew) {
      PieceStore store = must(PieceStore::open(folder_of(crew.rank), kOrigin, crew));
      store.add("of " + std::to_string(crew.rank), std::to_string(crew.rank));
      EXPECT_TRUE(store.gather(crew, {}));
      for (int other = 0; other < 3; ++other)
        EXPECT_EQ(*store.find("of " + std::to_string(other)), std::to_string(other));
    });
    EXPECT_EQ(lines_of(folder_of(0) / "runs.jsonl"), 3u) << "the leader has all";
    test::as_crew(2, [&](const Crew& crew) {
      const PieceStore store = must(PieceStore::open(folder_of(crew.rank), kOrigin, crew));
      EXPECT_NE(store.find("of 2"), nullptr) << "a smaller crew goes on";
    });
  }
}

TEST(PieceStore, AFolderThatOneCannotWriteIsAnErrorOfAll) {
  const test::TemporaryFolder folder;
  { std::ofstream(folder.path() / "file") << "no folder"; }
  test::as_crew(2, [&](const Crew& crew) {
    const auto store =
        PieceStore::open(crew.rank == 0 ? folder.path() : folder.path() / "file", kOrigin, crew);
    ASSERT_FALSE(store);
    EXPECT_NE(store.error().message().find("file"), std::string::npos);
  });
}

}  // namespace
}  // namespace mstsl
