#pragma once
// Surfaces that lie on each other. Which of the two a ray meets is decided by rounding: the level of an echo does not mind,
// its material and its label do.
#include <cstdint>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/scene/scene.h"

namespace echopath {

inline constexpr double kCoplanarDistance = 1e-5;  // m, up to which two surfaces are said to lie on each other

// Where two meshes of a scene, or a mesh and itself, lie on each other.
struct CoplanarOverlap {
  uint32_t first_mesh_id = 0, second_mesh_id = 0;  // first <= second
  int64_t num_triangles = 0;                       // of both meshes, that lie on one of the other
  double area = 0.0;                               // m^2, summed over pairs of triangles
  double distance = 0.0;                           // m, largest between the two
};

// All pairs of meshes with triangles that lie on each other at `time` (s): nowhere where one lies over the other are they
// further apart than max_distance (m), whichever way they face. Triangles that merely touch do not count, and neither do
// those that overlap by less than max_distance or a tenth of their height, whichever is less; nor do bodies that cross at an
// angle that takes them further apart within a triangle. Of meshes that are copies of each other (the same triangles in the
// same order, to the bit) the first stands for all: each copy is listed with it and with nothing else, so that k copies
// make k - 1 pairs instead of k^2 / 2. Sorted by mesh IDs. About n log n steps for n triangles (more where many long slivers
// lie in each other's bounding boxes, or many surfaces that are no copies on each other) and 400 bytes for each; the same
// bits for any number of threads.
// Raises invalid_argument for a max_distance that is not positive, for 2^31 triangles or more and for a time outside a
// motion; Cancelled.
std::vector<CoplanarOverlap> coplanar_overlaps(const Scene& scene, double time = 0.0,
                                               double max_distance = kCoplanarDistance, Job* job = nullptr);

}  // namespace echopath
