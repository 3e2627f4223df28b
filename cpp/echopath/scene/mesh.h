#pragma once
// One labelled surface: a triangle mesh, checked and repaired when it is made.
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

using Triangle = std::array<uint32_t, 3>;

class Mesh;
using MeshPtr = std::shared_ptr<const Mesh>;

// Immutable. No face of the input is lost except degenerate ones: sheets that meet in a non-manifold edge or vertex get
// vertices of their own there, so that faces keep their place and order. Vertices that no kept face uses are left out.
class Mesh {
 public:
  // vertices [V] in m, triangles [F] of vertex indices; source_triangle [F]: what original_triangle() shall name
  // instead of the index in `triangles`. Triangles with a non-finite vertex or without area (height at most 1e-12 of
  // the longest edge) are removed and counted. Raises invalid_argument for an index out of range or when no triangle is
  // left.
  Mesh(std::vector<Vec3> vertices, std::vector<Triangle> triangles, std::vector<uint32_t> source_triangle = {});
  ~Mesh();
  // Triangles [N] of `whole` as a mesh of its own, ascending and unique or sorted so; vertices keep their order, and
  // num_input_vertices() is that of `whole`, so that one Deformation serves all its parts. The part of a part is one of
  // the whole. Raises invalid_argument for no triangle or one out of range.
  static MeshPtr part(const MeshPtr& whole, std::vector<uint32_t> triangles);

  const std::vector<Vec3>& vertices() const { return vertices_; }        // [V] m, copies last
  const std::vector<Triangle>& triangles() const { return triangles_; }  // [F]
  // [F] face of the input or file, [V] vertex of the input.
  const std::vector<uint32_t>& original_triangle() const { return original_triangle_; }
  const std::vector<uint32_t>& original_vertex() const { return original_vertex_; }
  int64_t num_removed_triangles() const { return num_removed_triangles_; }
  int64_t num_input_vertices() const { return num_input_vertices_; }  // what a Deformation must have
  int64_t num_duplicated_vertices() const { return num_duplicated_vertices_; }
  bool is_closed() const { return is_closed_; }  // no boundary edge, no duplicated vertex
  double area() const { return area_; }          // m^2
  bool is_flat() const { return is_flat_; }      // all vertices in one plane, to 1e-6 of the extent

  // What this is a part of, null for a whole; and its triangles [F] and vertices [V] there, empty for a whole. Vertex
  // normals are those of the whole: a curved surface has no seams where it is cut into parts.
  const MeshPtr& whole() const { return whole_; }
  const std::vector<uint32_t>& whole_triangle() const { return whole_triangle_; }
  const std::vector<uint32_t>& whole_vertex() const { return whole_vertex_; }
  const Mesh& surface() const { return whole_ ? *whole_ : *this; }
  uint32_t surface_vertex(uint32_t vertex) const { return whole_ ? whole_vertex_[vertex] : vertex; }

 private:
  Mesh() = default;

  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<uint32_t> original_triangle_, original_vertex_;
  int64_t num_input_vertices_ = 0, num_removed_triangles_ = 0, num_duplicated_vertices_ = 0;
  bool is_closed_ = false, is_flat_ = false;
  double area_ = 0.0;  // m^2
  MeshPtr whole_;
  std::vector<uint32_t> whole_triangle_, whole_vertex_;
};

}  // namespace echopath
