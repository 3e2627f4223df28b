#pragma once
// Finds the sharp edges of a mesh: where its faces meet at an angle, and the rims where they end.
#include <span>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Faces that turn by less are taken for one curved surface; the crease guard of smooth meshes has the same angle.
inline constexpr double kSharpTurn = 0.5235987755982988;  // rad, 30 degrees

// Describes one straight edge along a side of a triangle, in the frame of the mesh. Side i leads from corner i to the next
// one.
struct SharpEdge {
  uint32_t triangle, side;
  double begin, end;  // the stretch of the side, in [0, 1]: less than the side where it meets several others
  Vec3 inward[2];     // unit, in each face, across the edge and away from it; both are the same at a rim
  Vec3 normal[2];     // unit, of each face on the side of the space around the edge
};

// Returns the edges of a mesh, ascending by triangle, side and begin. Faces count whatever their winding: the space around
// an edge is the widest between two of the faces that meet there, and the edge is sharp where it is wider than pi +
// kSharpTurn. Edges are found by where triangles lie, so that neither repeated vertices nor the corners of others on a side
// part what is connected (to 1e-6 of the extent). A part has the edges of the whole surface that lie on its triangles, and
// no rim where it is cut; of several triangles at one edge, that with the least index has it. Concave edges of a closed body
// are among them; nothing outside of it sees these.
std::vector<SharpEdge> find_sharp_edges(const Mesh& mesh);

// Returns the edge on which a point of a triangle's border lies; null where there is none.
const SharpEdge* sharp_edge_at(std::span<const SharpEdge> edges, uint32_t triangle, double u, double v);

// Holds barycentric coordinates of a triangle that name a point exactly on one of its sides.
struct PointOnSide {
  float u, v;
};
// Returns the point at `along` in [0, 1] of a side, rounded along the side.
PointOnSide point_on_side(uint32_t side, double along);

}  // namespace echopath
