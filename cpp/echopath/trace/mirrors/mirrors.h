#pragma once
// Finds the planes flagged `mirror`, and tells which coefficient of a surface holds for a polarisation.
#include <vector>

#include "echopath/base/plane.h"
#include "echopath/em/surface_response.h"
#include "echopath/trace/geometry/embree_scene.h"
#include "echopath/trace/geometry/plane_mesh.h"

namespace echopath {

// Describes a mirror mesh; its point is relative to the trace origin.
struct Mirror : Plane {
  uint32_t mesh_id = 0;
  const Material* material = nullptr;
  std::vector<Vec3> outline;  // corners of the convex hull, in order around it
  bool is_solid = false;      // the mesh fills its outline: it has no holes and no notches
  PlaneMesh mesh;
};

// Returns the corners of the convex hull of points of a mirror's plane, in order around it (Andrew 1979).
std::vector<Vec3> outline_of(const Mirror& mirror, const std::vector<Vec3>& points);

// Returns all mirror meshes of the scene. Raises invalid_argument naming a mesh that is not flat (0.1 mm plus 1e-6 of its
// size).
std::vector<Mirror> find_mirrors(const Scene& scene, const EmbreeScene& geometry);

// Decides between TE and TM at a hit by the transmit polarisation (scalar mode). It is TE where the part of `polarization`
// across `direction` lies within 45 degrees of the normal of the plane of incidence. It is TM where the field would lie
// along the direction of travel: only bounces in the plane of the field turn a ray that way. The part across is the mean (of
// squares) before and behind the bounce: both ways through it have one mode, so that a ray over a mirror and a leg that is
// searched from its other end have the same coefficient.
PolarizationMode polarization_mode(const Vec3& polarization, const Vec3& direction, const Vec3& normal);

// Returns the sign that a flagged mirror's coefficient takes along `polarization` (scalar mode), for a wave that travels
// along `direction`. Fresnel's TM coefficient is that along p_i and p_r (em/fresnel.h), of which one may point with the
// field and the other against it, as at a wall at right angles to the field, where TE and TM must meet at normal incidence.
// The sign is +1 for TE and for conductors.
double mirror_sign(const Material& material, PolarizationMode mode, const Vec3& polarization, const Vec3& direction,
                   const Vec3& normal);

// Returns the mode at a surface whose coefficients may depend on it; `direction` is the unit direction of travel.
inline PolarizationMode mode_along(const SurfaceModel& model, const Vec3& polarization, const Vec3& direction,
                                   const Vec3& normal) {
  return model.is_dielectric() ? polarization_mode(polarization, direction, normal) : PolarizationMode::kTe;
}

// Returns the response of a surface to a wave that travels along `direction`, a unit vector; `normal` is on the lit side.
inline SurfaceResponse respond_along(const SurfaceModel& model, const Vec3& polarization, const Vec3& direction,
                                     const Vec3& normal) {
  return model.respond(-direction.dot(normal), mode_along(model, polarization, direction, normal));
}

}  // namespace echopath
