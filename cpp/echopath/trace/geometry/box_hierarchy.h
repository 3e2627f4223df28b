#pragma once
// Holds boxes in a tree that tells which of them reach into a convex region.
#include <Eigen/Geometry>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

struct HalfSpace {
  Vec3 normal;    // inward
  double offset;  // m; normal.dot(p) >= offset is inside
};

// Returns whether the box has a corner in each of the half-spaces, not always the same one. This is true for all boxes that
// reach into their intersection, and for few others.
bool reaches_into(const Eigen::AlignedBox3d& box, const std::vector<HalfSpace>& region);

class BoxHierarchy {
 public:
  explicit BoxHierarchy(const std::vector<Eigen::AlignedBox3d>& boxes);
  // Sets `found` to the indices of the boxes that may reach into the region (`reaches_into`), ascending.
  void find(const std::vector<HalfSpace>& region, std::vector<int>& found) const;

 private:
  struct Branch {
    Eigen::AlignedBox3d box;
    int begin = 0, end = 0;  // in order_
    int second = -1;         // branch; the first one follows this branch. -1: a leaf
  };
  int grow(const std::vector<Eigen::AlignedBox3d>& boxes, int begin, int end);

  std::vector<Eigen::AlignedBox3d> boxes_;  // as in order_
  std::vector<int> order_;
  std::vector<Branch> branches_;
};

}  // namespace echopath
