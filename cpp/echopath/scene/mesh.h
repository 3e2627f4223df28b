#pragma once
// One labelled surface: a triangle mesh, checked and repaired when it is made.
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

using Triangle = std::array<uint32_t, 3>;

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

  const std::vector<Vec3>& vertices() const { return vertices_; }        // [V] m, copies last
  const std::vector<Triangle>& triangles() const { return triangles_; }  // [F]
  // [F] face of the input or file, [V] vertex of the input.
  const std::vector<uint32_t>& original_triangle() const { return original_triangle_; }
  const std::vector<uint32_t>& original_vertex() const { return original_vertex_; }
  int64_t num_removed_triangles() const { return num_removed_triangles_; }
  int64_t num_input_vertices() const { return num_input_vertices_; }  // what a VertexSequence must have
  int64_t num_duplicated_vertices() const { return num_duplicated_vertices_; }
  bool is_closed() const { return is_closed_; }  // no boundary edge, no duplicated vertex
  double area() const;                           // m^2

 private:
  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<uint32_t> original_triangle_, original_vertex_;
  int64_t num_input_vertices_ = 0, num_removed_triangles_ = 0, num_duplicated_vertices_ = 0;
  bool is_closed_ = false;
};

using MeshPtr = std::shared_ptr<const Mesh>;

}  // namespace echopath
