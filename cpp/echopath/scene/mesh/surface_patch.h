#pragma once
// Selects the vertices of a surface that must be posed where only some of its triangles are needed.
#include <vector>

#include "echopath/scene/mesh/creases.h"
#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Holds the corners of some triangles of a mesh and, where vertex normals are asked for, the neighbours that determine
// these. Vertices are those of mesh.surface(), so that normals at the rim of a part are those of the whole.
struct SurfacePatch {
  static constexpr uint32_t kAbsent = 0xFFFFFFFFu;
  std::vector<uint32_t> original_vertex;  // [n] vertex of the input, for a Deformation, in the order of the surface
  std::vector<uint32_t> place;            // [V of the mesh] index among the n, kAbsent where it is no corner
  // The triangles of the surface that meet a corner, as indices among the n, in the order of the surface; empty without
  // normals. Normals from them (scene/smooth/smooth.h) are right at the corners, to the same bits as those of the whole
  // surface.
  std::vector<Triangle> triangles;
  Creases creases;  // of these triangles, at rest

  Triangle corners(const Triangle& triangle) const { return {place[triangle[0]], place[triangle[1]], place[triangle[2]]}; }
};

// `takes` [F] marks the triangles of the mesh that are needed.
SurfacePatch make_patch(const Mesh& mesh, const std::vector<uint8_t>& takes, bool with_normals);

}  // namespace echopath
