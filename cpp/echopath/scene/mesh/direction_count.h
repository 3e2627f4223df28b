#pragma once

#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

// Finds out in how many of some even directions from a point triangles lie, along a spiral of golden angles from the one
// pole to the other. A direction counts once, however many triangles lie in it.
class DirectionCount {
 public:
  DirectionCount();

  // Takes a triangle in, whose corners are relative to the point. One through the point lies in no direction.
  void add(const Vec3& a, const Vec3& b, const Vec3& c);
  bool is_over_half() const { return 2 * num_met_ > static_cast<int>(directions_.size()); }

 private:
  std::vector<Vec3> directions_;
  std::vector<bool> is_met_;
  int num_met_ = 0;
};

}  // namespace echopath
