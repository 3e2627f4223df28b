#pragma once
// Measures how far a surface goes on around one of its points, whatever meshes and triangles it consists of.
#include "echopath/trace/geometry/embree_scene.h"

namespace echopath {

struct SurfaceEnd {
  double distance = 0.0;  // m, along the surface
  bool is_wall = false;   // something rises from it there (the inside of a corner): it ends, but has no edge
};

// A surface goes on over triangles that lie on each other's rims within `gap` (m) and turn away by at most 30 degrees from
// the point's normal; it may overlook a hole between the point and the place that is looked at. `along` is a unit tangent.
// Both functions add their rays to num_queries.

// Returns whether it goes on for `distance` (m). This costs a ray, or none where the point's own triangle reaches as far.
bool surface_reaches(const EmbreeScene& geometry, const RayHit& point, const Vec3& along, double distance, double gap,
                     int64_t& num_queries);

// Finds its end where it does not reach as far as `reach` (m). An edge lies where the last triangle ends, so that the
// distance does not depend on how the surface is cut into triangles and meshes. This costs some ten rays.
SurfaceEnd find_surface_end(const EmbreeScene& geometry, const RayHit& point, const Vec3& along, double reach, double gap,
                            int64_t& num_queries);

// Returns the distance in m from a point of the triangle that was hit along the unit tangent to the triangle's rim.
double distance_to_rim(const EmbreeScene& geometry, const Hit& hit, const Vec3& from, const Vec3& along);

}  // namespace echopath
