#pragma once
// Carries polarised fields over hits.
#include <span>

#include "echopath/em/polarization/jones.h"
#include "echopath/em/surface/surface_response.h"

namespace echopath {

// Reflects fields that travel along `direction`, a unit vector, at a mirror or a specular bounce. `normal` is on the lit
// side; `coherent` is the field share of the specular part (SurfaceResponse::coherent).
void reflect_fields(std::span<FieldVector> fields, const Vec3& direction, const Vec3& normal, const SurfaceModel& model,
                    double coherent);

// Radiates fields by physical optics toward the unit vector `out`, `scale` times.
void radiate_fields(std::span<FieldVector> fields, const Vec3& direction, const Vec3& normal, const Vec3& out,
                    const SurfaceModel& model, double scale);

// Carries fields over a mirror with the specular part that its surface has by itself, and turns their direction of travel.
// `normal` may be on either side.
void carry_over_mirror(std::span<FieldVector> fields, Vec3& direction, const Vec3& normal, const SurfaceModel& model);

}  // namespace echopath
