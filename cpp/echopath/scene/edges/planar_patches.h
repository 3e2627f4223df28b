#pragma once
// Finds the planes of a mesh.
#include <vector>

#include "echopath/scene/mesh/triangle_contacts.h"

namespace echopath {

// Returns by how much in m corners may stray from a plane of which they are parts, in a mesh of an extent in m.
inline double flat_tolerance(double extent) { return 1e-4 + 1e-6 * extent; }

// Returns the triangles of each plane of a mesh, ascending: sets that touch (mesh/triangle_contacts.h), whose corners all
// lie within `tolerance` (m) of one plane, grown from the largest of them. Each triangle belongs to one set; the sets stand
// in the order of their largest triangles.
std::vector<std::vector<uint32_t>> planar_patches(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                                  double tolerance);
// Does so where the contacts are known already.
std::vector<std::vector<uint32_t>> planar_patches(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                                  double tolerance, const TriangleContacts& contacts);

}  // namespace echopath
