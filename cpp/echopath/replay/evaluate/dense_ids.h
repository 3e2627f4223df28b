#pragma once
// Numbers distinct keys in the order in which they come.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echopath {

class DenseIds {
 public:
  // Returns the number of the key (a, b): new keys are numbered 0, 1, 2 ... in the order in which they come.
  uint32_t operator()(uint64_t a, uint64_t b = 0) {
    if (2 * keys_.size() >= slots_.size()) grow();
    size_t slot = slot_of(a, b);
    for (; slots_[slot] != kFree; slot = (slot + 1) & (slots_.size() - 1)) {
      const Key& key = keys_[slots_[slot]];
      if (key.a == a && key.b == b) return slots_[slot];
    }
    slots_[slot] = static_cast<uint32_t>(keys_.size());
    keys_.push_back({a, b});
    return slots_[slot];
  }
  size_t size() const { return keys_.size(); }
  // Forgets all keys but keeps the memory.
  void clear() {
    keys_.clear();
    slots_.assign(slots_.size(), kFree);
  }

 private:
  struct Key {
    uint64_t a, b;
  };
  static constexpr uint32_t kFree = ~uint32_t{0};

  size_t slot_of(uint64_t a, uint64_t b) const {
    // The multipliers are odd and without a pattern; the high bits of a product depend on all bits of its factors.
    const uint64_t mixed = (a ^ b * 0xD6E8FEB86659FD93u) * 0x9E3779B97F4A7C15u;
    return static_cast<size_t>((mixed ^ mixed >> 32) & (slots_.size() - 1));
  }
  void grow() {
    slots_.assign(slots_.empty() ? 256 : 2 * slots_.size(), kFree);
    for (size_t id = 0; id < keys_.size(); ++id) {
      size_t slot = slot_of(keys_[id].a, keys_[id].b);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<uint32_t>(id);
    }
  }

  std::vector<Key> keys_;
  std::vector<uint32_t> slots_;  // power of two, at most half full
};

}  // namespace echopath
