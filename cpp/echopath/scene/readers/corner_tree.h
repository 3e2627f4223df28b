#pragma once
// Holds the corners of a polygon in a tree of boxes, which finds quickly whether one lies in a triangle. Internal to the
// module.
#include <array>
#include <cstdint>
#include <vector>

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

  // Takes the corner at `place` [0, n) out.
  void remove(uint32_t place);
  // Returns whether a corner that was not taken out lies in the ear or on its edges.
  bool has_corner_in(const Ear& ear) const;

 private:
  static constexpr uint32_t kLeafSize = 8;
  struct Branch {
    Eigen::AlignedBox3d box;
    uint32_t begin = 0, end = 0;  // range in order_
    uint32_t second_half = 0;     // index of the second half, 0 for a leaf; the first half follows this branch
    uint32_t num_left = 0;
  };
  void halve(uint32_t begin, uint32_t end);
  bool has_corner_in(const Ear& ear, const Branch& leaf) const;

  const std::vector<Vec3>& vertices_;
  const std::vector<uint32_t>& corners_;
  std::vector<uint32_t> order_;     // [n] places
  std::vector<uint32_t> index_of_;  // [n] index in order_ of each place
  std::vector<uint8_t> is_left_;    // [n] by index in order_
  std::vector<Branch> branches_;    // each stands before those within it
};

}  // namespace echopath
