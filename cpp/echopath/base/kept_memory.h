#pragma once
// Memory that one computation leaves for the next: of a short one, pages that are touched for the first time cost as much as the
// work on them.
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace echopath {

// Of type T, which tells its num_bytes(). Thread-safe.
template <class T>
class KeptMemory {
 public:
  static constexpr size_t kMost = size_t{64} << 20;  // bytes in all

  // The one of the whole process, never destroyed: threads may outlive what is static.
  static KeptMemory& of_process() {
    static KeptMemory& memory = *new KeptMemory;
    return memory;
  }

  // What was left last, or new.
  std::unique_ptr<T> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!kept_.empty()) {
        std::unique_ptr<T> last = std::move(kept_.back());
        kept_.pop_back();
        num_bytes_ -= last->num_bytes();
        return last;
      }
    }
    return std::make_unique<T>();
  }

  // Frees it where there would be more than kMost, or where there is no memory to keep it: destructors call this.
  void leave(std::unique_ptr<T> memory) noexcept {
    const size_t num_bytes = memory->num_bytes();
    const std::lock_guard lock(mutex_);
    if (num_bytes_ + num_bytes > kMost) return;
    try {
      kept_.push_back(std::move(memory));
      num_bytes_ += num_bytes;
    } catch (const std::bad_alloc&) {
    }
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> kept_;
  size_t num_bytes_ = 0;
};

}  // namespace echopath
