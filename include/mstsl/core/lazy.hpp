#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace mstsl {

/// A value that is made when it is first asked for, then kept: for what is large and seldom wanted. Many
/// threads may ask at once; one makes it, the others wait.
template <typename T>
class Lazy {
 public:
  /// `make` holds all that it needs, and must give the same value whenever it is called.
  explicit Lazy(std::function<T()> make) : state_(std::make_unique<State>(std::move(make))) {}

  const T& operator*() const {
    std::call_once(state_->once, [this] {
      state_->value.emplace(state_->make());
      state_->make = nullptr;  // and with it what it held
    });
    return *state_->value;
  }
  const T* operator->() const { return &**this; }

 private:
  struct State {
    explicit State(std::function<T()> how) : make(std::move(how)) {}
    std::function<T()> make;
    std::once_flag once;
    std::optional<T> value;
  };
  std::unique_ptr<State> state_;
};

}  // namespace mstsl
