#include "piecework.hpp"

#include <utility>

#include <fmt/format.h>

namespace mstsl {

double Piecework::share() {
  const std::scoped_lock lock(mutex_);
  return expected_ == 0 ? 1.0 : static_cast<double>(done_) / static_cast<double>(expected_);
}

void Piecework::tell(const char* what, double share) {
  const std::scoped_lock lock(mutex_);
  if (progress_ && !stopped_ && !progress_(what, share)) stopped_ = true;
}

void Piecework::finish(const std::vector<std::pair<std::string, std::string>>& contents) {
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& [name, content] : contents) store_.add(name, content);
    ++done_;
  }
  tell("runs", share());
}

void Piecework::fail(Error error) {
  const std::scoped_lock lock(mutex_);
  if (!error_) error_ = std::move(error);
  stopped_ = true;
}

Result<void> Piecework::end() const {
  if (error_) return *error_;
  if (!store_.good()) return Error("finished runs cannot be written; is the disk full?");
  if (stopped_)
    return Error(fmt::format("interrupted after {} of {} starts; {}", done_, expected_,
                             store_.keeps() ? "the same command goes on from there" : "nothing was kept"));
  return {};
}

}  // namespace mstsl
