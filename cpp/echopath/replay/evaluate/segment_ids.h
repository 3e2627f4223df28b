#pragma once
// Stores a value for each distinct run of neighbouring hits of a record; runs are told apart by their contents.
#include <cstdint>
#include <cstring>
#include <vector>

#include "echopath/record/paths.h"

namespace echopath {

class SegmentIds {
 public:
  static constexpr uint32_t kNone = ~uint32_t{0};

  // Returns the value of `count` hits under `kind`; it is kNone for a new run, and the caller then sets it. The hits must
  // stay where they are. The reference is valid until the next call.
  uint32_t& operator()(const Hit* hits, int count, uint64_t kind) {
    if (2 * size_ >= entries_.size()) grow();
    const uint64_t hash = hash_of(hits, count, kind);
    size_t slot = hash & (entries_.size() - 1);
    while (is_taken(entries_[slot]) && !is(entries_[slot], hash, hits, count, kind))
      slot = (slot + 1) & (entries_.size() - 1);
    Entry& entry = entries_[slot];
    if (!is_taken(entry)) {
      entry = {hits, hash, kind, kNone, static_cast<uint16_t>(count), generation_};
      ++size_;
    }
    return entry.value;
  }

  // Forgets all runs but keeps the memory.
  void clear() {
    size_ = 0;
    if (++generation_ != 0) return;
    entries_.assign(entries_.size(), {});
    generation_ = 1;
  }

 private:
  struct Entry {
    const Hit* hits = nullptr;
    uint64_t hash = 0, kind = 0;
    uint32_t value = kNone;
    uint16_t count = 0, generation = 0;  // generation: the one in which the entry was taken
  };

  bool is_taken(const Entry& entry) const { return entry.generation == generation_; }
  static bool is(const Entry& entry, uint64_t hash, const Hit* hits, int count, uint64_t kind) {
    return entry.hash == hash && entry.kind == kind && entry.count == count &&
           (entry.hits == hits || std::memcmp(entry.hits, hits, static_cast<size_t>(count) * sizeof(Hit)) == 0);
  }
  // The multipliers are odd and without a pattern; the high bits of a product depend on all bits of its factors, and the
  // shifts bring them down.
  static uint64_t hash_of(const Hit* hits, int count, uint64_t kind) {
    uint64_t hash = kind * 0xD6E8FEB86659FD93u + static_cast<uint64_t>(count);
    for (int k = 0; k < count; ++k) {
      uint64_t words[2];
      std::memcpy(words, hits + k, sizeof words);
      hash = ((hash ^ words[0]) * 0x9E3779B97F4A7C15u) ^ (words[1] * 0xC2B2AE3D27D4EB4Fu);
      hash ^= hash >> 29;
    }
    hash *= 0x9E3779B97F4A7C15u;
    return hash ^ hash >> 32;
  }
  void grow() {
    std::vector<Entry> old(entries_.empty() ? 256 : 2 * entries_.size());
    old.swap(entries_);
    for (const Entry& entry : old) {
      if (!is_taken(entry)) continue;
      size_t slot = entry.hash & (entries_.size() - 1);
      while (is_taken(entries_[slot])) slot = (slot + 1) & (entries_.size() - 1);
      entries_[slot] = entry;
    }
  }

  std::vector<Entry> entries_;  // power of two, at most half full
  size_t size_ = 0;
  uint16_t generation_ = 1;  // grows with each clear()
};

}  // namespace echopath
