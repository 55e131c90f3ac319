#include "mstsl/core/crew.hpp"

#include <cassert>

namespace mstsl {
namespace {

constexpr char kGood = '+', kBad = '-';

std::string packed(const Result<std::string>& mine) {
  return mine ? kGood + *mine : kBad + mine.error().message();
}

}  // namespace

Result<std::vector<std::string>> pooled(const Crew& crew, const Result<std::string>& mine) {
  if (crew.size == 1) {
    if (!mine) return mine.error();
    return std::vector{*mine};
  }
  std::vector<std::string> all = crew.all_gather(packed(mine));
  assert(static_cast<int>(all.size()) == crew.size);
  for (const std::string& one : all)
    if (one.empty() || one.front() != kGood)
      return Error(one.empty() ? "a process said nothing" : one.substr(1));
  for (std::string& one : all) one.erase(0, 1);
  return all;
}

Portion portion_of(std::size_t count, const Crew& crew) {
  const auto rank = static_cast<std::size_t>(crew.rank), size = static_cast<std::size_t>(crew.size);
  return {count * rank / size, count * (rank + 1) / size};
}

}  // namespace mstsl
