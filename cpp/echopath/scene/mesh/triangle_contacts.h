#pragma once
// Finds the triangles of a mesh that go on in each other's plane, whether or not they share both ends of a side.
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "echopath/scene/mesh/adjacency.h"

namespace echopath {

// Holds which triangles touch. Where one alone lies at an edge, or more than two do, their sides are compared by where they
// lie: files cut walls into strips whose corners lie on the sides of others, list triangles twice, and join more than two
// surfaces at one edge. This takes about n log n steps for n such sides.
class TriangleContacts {
 public:
  // Such sides touch where they are nowhere further apart than `tolerance` (m), along more than that, and a triangle lies as
  // near to the plane of the other. Vertices and triangles must outlive it.
  TriangleContacts(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, double tolerance);

  // Returns the triangles that touch a triangle, each at least once.
  std::vector<uint32_t> touching(uint32_t triangle) const;
  // Returns the length in m of the sides of a triangle at which none of those that `is_other` tells goes on, on the other
  // side of them.
  double open_length(uint32_t triangle, const std::function<bool(uint32_t)>& is_other) const;

 private:
  struct Side {
    uint32_t triangle, side;
  };
  struct Contact {
    uint32_t triangle, side, other;
    double begin, end;  // m, along the side
    bool is_beyond;     // the other triangle lies on the other side of it
  };
  void compare_open_sides(double tolerance);
  void add_contact(const Side& side, const Side& other, double tolerance);
  const Vec3& corner(const Side& side, uint32_t further) const {
    return vertices_[triangles_[side.triangle][(side.side + further) % 3]];
  }
  Vec3 across(const Side& side, const Vec3& point) const;
  bool goes_on_beyond(const Side& side, uint32_t next) const;
  std::span<const Contact> contacts_of(uint32_t triangle) const;

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  std::vector<std::array<uint32_t, 3>> neighbours_;
  std::vector<Contact> contacts_;  // ascending by triangle, side and begin
};

}  // namespace echopath
