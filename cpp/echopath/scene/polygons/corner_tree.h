#pragma once
// Holds the corners of a polygon in a tree of boxes, which finds quickly whether one lies in a triangle. Internal to the
// module.
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/base/box_tree.h"
#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Returns how far the way from a over b to c turns, seen against the normal: above 0 to the left, below 0 to the right.
inline double turn(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return (b - a).cross(c - b).dot(normal);
}

// Holds a triangle of a polygon with that normal, turning about it as the polygon does.
struct Ear {
  std::array<Vec3, 3> points;
  Triangle vertices;  // indices of the points; corners with these vertices are none that could lie inside
  Vec3 normal;

  bool holds(const Vec3& point) const;
};

class CornerTree {
 public:
  // corners [n] are indices into `vertices`; both must outlive the tree.
  CornerTree(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners);

  // Takes one of the corners [0, n) out.
  void remove(uint32_t corner);
  // Returns whether a corner that was not taken out lies in the ear or on its edges.
  bool has_corner_in(const Ear& ear) const;

 private:
  bool has_corner_in(const Ear& ear, const BoxTree::Branch& leaf) const;

  const std::vector<Vec3>& vertices_;
  const std::vector<uint32_t>& corners_;
  BoxTree tree_;
  std::vector<uint32_t> place_of_;  // [n] in the tree, of each corner
  std::vector<uint8_t> is_left_;    // [n] by place in the tree
  std::vector<uint32_t> num_left_;  // of each branch
};

}  // namespace echopath
