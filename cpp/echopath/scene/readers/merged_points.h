#pragma once
// Gives points of equal coordinates one number, for formats that repeat a vertex in each triangle. Internal to the module.
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "echopath/base/bit_sum.h"
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
      BitSum sum;
      sum.add(key);
      return static_cast<size_t>(sum.value());
    }
  };

  std::vector<Vec3>& points_;
  std::unordered_map<Key, uint32_t, Hash> index_;
};

}  // namespace echopath
