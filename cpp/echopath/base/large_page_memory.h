#pragma once
// Memory for many arrays of some kilobytes that all live equally long.
#include <memory_resource>
#include <mutex>

namespace echopath {

// Hands out pieces of large chunks (base/large_array.h), one behind the other, and gives all of them back at its end. From any
// thread. An array that grows leaves its old piece behind.
class LargePageMemory : public std::pmr::memory_resource {
 public:
  LargePageMemory() : pieces_(kFirstChunk, &chunks_) {}

 private:
  static constexpr size_t kFirstChunk = size_t{1} << 22;  // bytes; later ones grow

  class Chunks : public std::pmr::memory_resource {
    void* do_allocate(size_t num_bytes, size_t alignment) override;
    void do_deallocate(void* data, size_t num_bytes, size_t alignment) override;
    bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }
  };

  void* do_allocate(size_t num_bytes, size_t alignment) override;
  void do_deallocate(void*, size_t, size_t) override {}
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  Chunks chunks_;
  std::pmr::monotonic_buffer_resource pieces_;
  std::mutex mutex_;
};

}  // namespace echopath
