#pragma once
// Joins numbered things into sets that have no member in common.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace echopath {

// Begins with a set for each thing. A set is named by its least member, so that names follow the numbers of the things.
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  // Returns the name of the set that holds the member.
  uint32_t find(uint32_t member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
    return member;
  }
  void join(uint32_t a, uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  // Returns the name of the set of each thing.
  std::vector<uint32_t> names() {
    for (uint32_t member = 0; member < parent_.size(); ++member) parent_[member] = find(member);
    return parent_;
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace echopath
