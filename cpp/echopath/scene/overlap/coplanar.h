#pragma once
// Finds surfaces that lie on each other. Rounding decides which of the two a ray hits: the level of the echo does not depend
// on it, but its material and its label do.
#include <cstdint>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/scene/scene.h"

namespace echopath {

inline constexpr double kCoplanarDistance = 1e-5;  // m, largest distance of surfaces that lie on each other

// Describes where two meshes of a scene, or a mesh and itself, lie on each other.
struct CoplanarOverlap {
  uint32_t first_mesh_id = 0, second_mesh_id = 0;  // first <= second
  int64_t num_triangles = 0;                       // triangles of both meshes that lie on one of the other
  double area = 0.0;                               // m^2, summed over pairs of triangles
  double distance = 0.0;                           // m, largest between the two surfaces
};

// Returns all pairs of meshes that have triangles on each other at `time` (s): where one lies over the other, they are
// nowhere further apart than max_distance (m), whichever way they face. It does not count triangles that merely touch, those
// that overlap by less than max_distance or a tenth of their height, whichever is less, and bodies that cross at an angle
// that takes them further apart within a triangle. Of meshes that are copies of each other (the same triangles in the same
// order, to the bit) the first represents all: each copy is listed with the first only, so that k copies make k - 1 pairs
// instead of k^2 / 2. Pairs are sorted by mesh IDs. The search takes about n log n steps for n triangles (more where many
// long slivers lie in each other's bounding boxes, or where many surfaces that are not copies lie on each other) and 400
// bytes per triangle. The result has the same bits for any number of threads.
// Raises invalid_argument for a max_distance that is not positive, for 2^31 triangles or more and for a time outside a
// motion; raises Cancelled when the job is cancelled.
std::vector<CoplanarOverlap> coplanar_overlaps(const Scene& scene, double time = 0.0,
                                               double max_distance = kCoplanarDistance, Job* job = nullptr);

}  // namespace echopath
