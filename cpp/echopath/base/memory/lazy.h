#pragma once
// Holds a value that is made when it is first asked for.
#include <mutex>
#include <optional>

namespace echopath {

// It is thread-safe: whoever asks first makes the value, all others wait for it. Where making it throws, the next one makes
// it.
// What makes it must neither ask the same value nor run a parallel loop: a thread that waits in the loop may take up a task
// that asks it.
template <class T>
class Lazy {
 public:
  template <class Make>
  const T& get(Make make) const {
    std::call_once(once_, [&] { value_.emplace(make()); });
    return *value_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::optional<T> value_;
};

}  // namespace echopath
