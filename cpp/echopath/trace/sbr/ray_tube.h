#pragma once
// Follows the tube of a coherent ray over smooth surfaces: its area, its caustics and its footprint.
#include "echopath/trace/sbr/ray.h"

namespace echopath {

// Carries the tube to the surface where the ray arrives; caustics on the way turn the phase of the field.
void carry_tube(Ray& ray, SurfaceHit& surface, double wavelength);

// Reflects the tube, before the direction of the ray changes.
void reflect_tube(Ray& ray, const SurfaceHit& surface);

// Returns the launch cell on the triangle that was hit (Paths::curved_cell), for so many rays per sr in the lattice of the
// ray. `corners` are those of the triangle.
std::array<float, 7> footprint_of_tube(const Ray& ray, const SurfaceHit& surface, const std::array<Vec3, 3>& corners,
                                       double lattice_density);

}  // namespace echopath
