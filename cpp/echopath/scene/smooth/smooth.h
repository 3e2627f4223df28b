#pragma once
// Models the curved surface that a triangle mesh stands for: vertex normals, and per triangle a normal, a position and a
// curvature.
#include <array>
#include <vector>

#include "echopath/scene/mesh/creases.h"
#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Returns unit vertex normals [V] by the weights of Max 1999 ("Weights for computing vertex normals from facet normals"),
// which are exact for vertices on a sphere at any tessellation. At creases they are those of the surface that keeps the
// vertex. They are zero where no triangle meets.
std::vector<Vec3> vertex_normals(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                 const Creases& creases = {});

// Returns the unit vertex normals [V] of a mesh at rest, with its creases; a part takes those of the whole surface.
std::vector<Vec3> vertex_normals(const Mesh& mesh);

// Returns the matrix that takes normals of a mesh's frame to the world, up to their length; they follow the winding of the
// triangles.
Mat3 cofactor_matrix(const Mat3& world_from_mesh);

// Returns whether a triangle may be taken as smooth: each vertex normal must lie within 30 degrees of the facet's (crease
// guard: a box taken as smooth errs by tens of dB).
bool is_smooth_facet(const Vec3& facet_normal, const std::array<Vec3, 3>& normals);

// Describes the curved surface at a barycentric point. Curvature is positive on the side of `normal` for a convex surface: a
// step x in the tangent plane turns the normal by `curvature * x` (1/m, symmetric, curvature * normal = 0).
struct SmoothPoint {
  Vec3 position;  // m: on the curved surface, not on the facet
  Vec3 normal;    // unit
  Mat3 curvature;
  double stretch;  // area of the curved surface over that of the facet
};

// Evaluates the surface over a triangle with the given corners and unit vertex normals at barycentric u, v. The position is
// p + (1/2) sum b_i [(p_i - p).n_i] n_i; the curvature is that of the linear field of normals over the triangle,
// symmetrised.
SmoothPoint smooth_point(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals, double u, double v);

// Returns a tangent vector as (du, dv) in units of the triangle's edges, which are projected on the tangent plane of
// `normal`.
Eigen::Vector2d edge_coordinates(const Vec3& edge_u, const Vec3& edge_v, const Vec3& normal, const Vec3& tangent);

}  // namespace echopath
