#pragma once
// Gives points of equal coordinates one number, for formats that repeat a vertex in each triangle. Internal to the module.
#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

class MergedPoints {
 public:
  // New points are appended to `points`, which must outlive this.
  explicit MergedPoints(std::vector<Vec3>& points) : points_(points) {}

  // Returns the index of a point in `points`; -0.0 and 0.0 are one number.
  uint32_t index_of(const Vec3& point) {
    const Key key{point.x() + 0.0, point.y() + 0.0, point.z() + 0.0};
    const auto [entry, added] = index_.try_emplace(key, static_cast<uint32_t>(points_.size()));
    if (added) points_.push_back(point);
    return entry->second;
  }

 private:
  using Key = std::array<double, 3>;
  struct Hash {
    size_t operator()(const Key& key) const {
      uint64_t sum = 0;
      for (const double value : key) {  // mixes as splitmix64 does (Steele, Lea, Flood 2014)
        sum += std::bit_cast<uint64_t>(value) + 0x9E3779B97F4A7C15u;
        sum = (sum ^ (sum >> 30)) * 0xBF58476D1CE4E5B9u;
        sum = (sum ^ (sum >> 27)) * 0x94D049BB133111EBu;
        sum ^= sum >> 31;
      }
      return static_cast<size_t>(sum);
    }
  };

  std::vector<Vec3>& points_;
  std::unordered_map<Key, uint32_t, Hash> index_;
};

}  // namespace echopath
