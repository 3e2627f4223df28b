#pragma once
// Gives the points of rough surfaces that scatter where they are to be the same in every trace of a scene.
//
// Rays meet a surface wherever they are launched to, so that two traces give it two sets of scatterers and two speckle
// patterns. Here every triangle has one endless set of points of its own, in an order in which each first part of it is
// even over the triangle. A trace takes as many of them as its rays would meet: point number i where (i + shift)/area is
// below the density that is asked for there. From one time to the next, points come and go at the end of the order alone,
// and all others stay where they are on the surface, with their random numbers. Source: the order is that of Basu and Owen
// 2015, a van der Corput sequence over a triangle, with places and digits drawn at random.
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/record/paths.h"

namespace echopath {

// Describes a triangle with points; its corners are in the coordinates of their viewer.
struct ScatteringTriangle {
  TriangleName name;
  uint32_t mesh_number;  // SceneMesh::number, by which its random numbers go: another than the ID where meshes are hidden
  std::array<Vec3, 3> corners;
};

struct SurfacePoint {
  Vec3 position;
  TriangleName on{};
  int64_t key = 0;  // of its random numbers: 63 random bits, which no two points of a scene share but by chance
  int stratum = 0;  // whose rays it takes the place of
  bool operator==(const SurfacePoint&) const = default;
};

// Says how many points there are to be about a viewer: as many as a lattice of rays from there would meet, `ray_density`
// [1/sr] cos/r^2 per m^2.
struct PointDensity {
  Vec3 viewer;
  double ray_density = 0.0;
};

// Appends the points of a triangle, whichever of its sides the viewer sees. The random numbers go by its mesh's number and
// its own ID alone.
void add_surface_points(uint64_t seed, const ScatteringTriangle& triangle, const PointDensity& density,
                        std::vector<SurfacePoint>& out);

}  // namespace echopath
