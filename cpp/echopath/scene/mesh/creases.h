#pragma once
// Finds the vertices where a curved surface ends in a crease, such as the rim of a cylinder with caps.
#include <cstdint>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

inline constexpr double kCreaseCosine = 0.86602540378443865;  // 30 degrees between a facet and the normal at its corner

// Holds vertices at which surfaces meet in a crease of more than 60 degrees, twice that between a facet and its normals. A
// mean normal over all of them would fit none, so that a cylinder would lose its curvature at its caps. One surface keeps
// the vertex, that of the larger area among those that are curved there; a flat one needs no normals.
struct Creases {
  struct Corner {
    uint32_t triangle;
    uint32_t corner;  // 0 to 2
  };
  std::vector<uint32_t> vertices;
  std::vector<size_t> first = {0};  // [vertices + 1] the first of the corners of each
  std::vector<Corner> corners;      // of the surface that keeps the vertex, in the order of the triangles
};

// Looks at the shape given, that of a mesh at rest: a mesh that deforms keeps its creases.
Creases find_creases(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

// Returns the facet normal times the weight that Max 1999 ("Weights for computing vertex normals from facet normals") gives
// corner number `corner` of a triangle.
inline Vec3 weighted_normal(const std::vector<Vec3>& vertices, const Triangle& triangle, size_t corner) {
  const Vec3& middle = vertices[triangle[corner]];
  const Vec3 next = vertices[triangle[(corner + 1) % 3]] - middle, last = vertices[triangle[(corner + 2) % 3]] - middle;
  // sin(angle) / (|next| |last|) along the facet normal is the cross product over both squared lengths.
  return next.cross(last) / (next.squaredNorm() * last.squaredNorm());
}

// Returns the sum [V] of the facet normals at each vertex by these weights.
std::vector<Vec3> sums_of_weighted_normals(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

}  // namespace echopath
