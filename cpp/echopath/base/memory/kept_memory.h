#pragma once
// Keeps the memory that one computation leaves for the next: in a short one, pages that are touched for the first time cost
// as much as the work on them. The process has one home for it, with one budget.
//
// Scratch of a few kB is not kept here, but is thread_local where it is used; what holds results, and not mere memory, has
// its own homes (base/memory/recent_results.h, KeptGeometry).
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <typeindex>
#include <typeinfo>

namespace echopath {

// Keeps memory of any type T that tells its num_bytes(). It is thread-safe.
class KeptMemory {
 public:
  static constexpr size_t kMost = size_t{128} << 20;
  explicit KeptMemory(size_t most = kMost) : most_(most) {}  // bytes in all, whatever their types

  // Returns the one of the whole process, which is never destroyed: threads may outlive what is static.
  static KeptMemory& of_process();

  // Returns the smallest of this type that has so many bytes; where none has, the largest, which is to make room, so that
  // there are never more of them than were in use at once; and a new one, which has no bytes, where there is none at all.
  // Among equal ones it takes the one that was left last, which may still be in the cache.
  template <class T>
  std::unique_ptr<T> take(size_t num_bytes = std::numeric_limits<size_t>::max()) {
    Memory found = take(typeid(T), num_bytes);
    return found ? std::unique_ptr<T>(static_cast<T*>(found.release())) : std::make_unique<T>();
  }

  // Frees what has been here longest, of any type, until there is room. Nothing is kept of what is larger than the budget or
  // empty, nor where there is no memory for it: destructors call this.
  template <class T>
  void leave(std::unique_ptr<T> memory) noexcept {
    if (!memory || memory->num_bytes() == 0) return;
    const size_t num_bytes = memory->num_bytes();
    const auto free = [](void* of_type) { delete static_cast<T*>(of_type); };
    keep(typeid(T), num_bytes, sizeof(T) + num_bytes, {memory.release(), free});
  }

 private:
  using Memory = std::unique_ptr<void, void (*)(void*)>;
  // Keys stand in the order of types, sizes and times, the last time first.
  struct Key {
    std::type_index type;
    size_t num_bytes;
    int64_t time;
    auto operator<=>(const Key&) const = default;
  };
  struct Piece {
    Key key;
    size_t cost;  // bytes, with those of the object
    Memory memory;
  };
  using Index = std::map<Key, std::list<Piece>::iterator>;

  Memory take(std::type_index type, size_t num_bytes);
  Index::iterator find(std::type_index type, size_t num_bytes);
  void keep(std::type_index type, size_t num_bytes, size_t cost, Memory memory) noexcept;
  void insert(Piece piece);

  const size_t most_;
  std::mutex mutex_;
  std::list<Piece> pieces_;  // the one that was left first, first
  Index index_;
  size_t cost_ = 0;   // of all
  int64_t time_ = 0;  // of the last piece; counts down
};

}  // namespace echopath
