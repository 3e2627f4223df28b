#pragma once
// Finds the normals of vertices where a curved surface ends in a crease, such as the rim of a cylinder with caps. Internal
// to the folder.
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

inline constexpr double kCreaseCosine = 0.86602540378443865;  // 30 degrees between a facet and the normal at its corner

// Returns the facet normal times the weight that Max 1999 gives the corner number `corner` of a triangle.
inline Vec3 weighted_normal(const std::vector<Vec3>& vertices, const Triangle& triangle, size_t corner) {
  const Vec3& middle = vertices[triangle[corner]];
  const Vec3 next = vertices[triangle[(corner + 1) % 3]] - middle, last = vertices[triangle[(corner + 2) % 3]] - middle;
  // sin(angle) / (|next| |last|) along the facet normal is the cross product over both squared lengths.
  return next.cross(last) / (next.squaredNorm() * last.squaredNorm());
}

// Replaces normals of vertices [V] at which surfaces meet in a crease of more than 60 degrees, twice that between a facet
// and its normals. A mean over all of them would fit none, so that a cylinder would lose its curvature at its caps. One
// surface keeps the vertex, that of the larger area among those that are curved there; a flat one needs no normals.
// Vertices without a crease keep what they have.
void replace_normals_at_creases(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                std::vector<Vec3>& normals);

}  // namespace echopath
