#pragma once
// Holds boxes in a tree that tells which of them reach into a convex region.
#include <vector>

#include "echopath/base/box_tree.h"
#include "echopath/base/geometry.h"

namespace echopath {

struct HalfSpace {
  Vec3 normal;    // inward
  double offset;  // m; normal.dot(p) >= offset is inside
};

// Returns whether the box has a corner in each of the half-spaces, not always the same one. This is true for all boxes that
// reach into their intersection, and for few others.
bool reaches_into(const Box& box, const std::vector<HalfSpace>& region);

class BoxHierarchy {
 public:
  explicit BoxHierarchy(std::vector<Box> boxes);
  // Sets `found` to the indices of the boxes that may reach into the region (`reaches_into`), ascending.
  void find(const std::vector<HalfSpace>& region, std::vector<int>& found) const;

 private:
  std::vector<Box> boxes_;
  BoxTree tree_;
};

}  // namespace echopath
