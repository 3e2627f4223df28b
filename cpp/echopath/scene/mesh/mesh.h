#pragma once
// A mesh is one labelled surface of triangles, checked and repaired when it is made.
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/scene/runs/triangle_runs.h"

namespace echopath {

using Triangle = std::array<uint32_t, 3>;

// Returns the cross product of two sides of a triangle of these vertices (base/geometry.h).
inline Vec3 cross_of_sides(const std::vector<Vec3>& vertices, const Triangle& triangle) {
  return cross_of_sides(vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]);
}

struct SharpEdge;  // scene/edges/sharp_edges.h

class Mesh;
using MeshPtr = std::shared_ptr<const Mesh>;

// Meshes are immutable. No face of the input is lost except degenerate ones: sheets that meet in a non-manifold edge or
// vertex get vertices of their own there, so that faces keep their place and order. Vertices that no kept face uses are left
// out.
class Mesh {
 public:
  // vertices [V] in m, triangles [F] of vertex indices; original_triangle() names source_triangle [F], where it is given,
  // instead of the index in `triangles`. Triangles without area (height at most 1e-12 of the longest edge) are removed and
  // counted. Raises invalid_argument for an index out of range, for a vertex of a triangle that is not finite or beyond
  // 1e70 m, or when no triangle is left.
  Mesh(std::vector<Vec3> vertices, std::vector<Triangle> triangles, std::vector<uint32_t> source_triangle = {});
  ~Mesh();
  // Returns some triangles [N] of `whole` as a mesh of its own; they are sorted, and repeated ones are dropped. Vertices
  // keep their order, and num_input_vertices() is that of `whole`, so that one Deformation serves all its parts. A part of a
  // part is a part of the whole. Raises invalid_argument for no triangle or one out of range.
  static MeshPtr part(const MeshPtr& whole, std::vector<uint32_t> triangles);

  const std::vector<Vec3>& vertices() const { return vertices_; }        // [V] m, duplicated ones last
  const std::vector<Triangle>& triangles() const { return triangles_; }  // [F]
  // These return the face [F] of the input or file, and the vertex [V] of the input, from which each one was made.
  const std::vector<uint32_t>& original_triangle() const { return original_triangle_; }
  const std::vector<uint32_t>& original_vertex() const { return original_vertex_; }
  int64_t num_removed_triangles() const { return num_removed_triangles_; }
  int64_t num_input_vertices() const { return num_input_vertices_; }  // as many as a Deformation must have
  int64_t num_duplicated_vertices() const { return num_duplicated_vertices_; }
  bool is_closed() const { return is_closed_; }  // no boundary edge, no duplicated vertex
  double area() const { return area_; }          // m^2
  bool is_flat() const { return is_flat_; }      // all vertices in one plane, to 1e-6 of the extent
  const Box& box() const { return box_; }        // m, of the vertices
  const std::vector<Box>& boxes_of_runs() const { return boxes_of_runs_; }  // m
  // These return the edges that find_sharp_edges finds, and the triangles that edge_neighbours finds [F]; they look for them
  // at the first call, and are thread-safe.
  const std::vector<SharpEdge>& sharp_edges() const;
  const std::vector<std::array<uint32_t, 3>>& neighbours() const;

  // whole() is the mesh that this one is a part of, null for a whole; whole_triangle() [F] and whole_vertex() [V] are the
  // indices there, empty for a whole. Vertex normals are those of the whole, so that a curved surface has no seams where it
  // is cut into parts.
  const MeshPtr& whole() const { return whole_; }
  const std::vector<uint32_t>& whole_triangle() const { return whole_triangle_; }
  const std::vector<uint32_t>& whole_vertex() const { return whole_vertex_; }
  const Mesh& surface() const { return whole_ ? *whole_ : *this; }
  uint32_t surface_vertex(uint32_t vertex) const { return whole_ ? whole_vertex_[vertex] : vertex; }

 private:
  Mesh();
  void measure();

  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<uint32_t> original_triangle_, original_vertex_;
  int64_t num_input_vertices_ = 0, num_removed_triangles_ = 0, num_duplicated_vertices_ = 0;
  bool is_closed_ = false, is_flat_ = false;
  double area_ = 0.0;  // m^2
  Box box_;            // m
  std::vector<Box> boxes_of_runs_;
  MeshPtr whole_;
  std::vector<uint32_t> whole_triangle_, whole_vertex_;
  struct Found;
  std::shared_ptr<Found> found_;  // never null
};

}  // namespace echopath
