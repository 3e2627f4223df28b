#pragma once
// Finds the planes flagged `mirror`, and tells which coefficient of a surface holds for a polarisation.
#include <memory>
#include <string>
#include <vector>

#include "echopath/base/plane.h"
#include "echopath/em/surface/surface_response.h"
#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/geometry/plane_mesh.h"

namespace echopath {

class MirrorsInPlane;

// Describes a plane of a flagged mesh; its point is relative to the trace origin.
struct Mirror : Plane {
  uint32_t mesh_id = 0;
  int face = -1;                    // which of its planes, where the mesh has several; -1: the whole mesh
  std::vector<uint32_t> triangles;  // of the face; empty: all of the mesh
  const Material* material = nullptr;
  std::vector<Vec3> outline;  // corners of the convex hull, in order around it
  bool is_solid = false;      // the triangles fill the outline: they leave no holes and no notches
  PlaneMesh mesh;
  std::shared_ptr<const MirrorsInPlane> coplanar;  // others that lie on this one (coplanar_mirrors.h); null: none
};

// Returns the corners of the convex hull of points of a mirror's plane, in order around it (Andrew 1979).
std::vector<Vec3> outline_of(const Mirror& mirror, const std::vector<Vec3>& points);

// Returns the planes of all flagged meshes of the scene: one of a mesh that is flat (to 0.1 mm plus 1e-6 of its size),
// else those that its triangles make (scene/edges/planar_patches.h). Raises invalid_argument naming a smooth mesh that is
// not flat.
std::vector<Mirror> find_mirrors(const Scene& scene, const EmbreeScene& geometry);

// Returns the name of the mirror's mesh, with the number of its face where the mesh has several.
std::string name_of(const Mirror& mirror, const Scene& scene);

// Tells on which mirror a hit lies.
class MirrorIndex {
 public:
  MirrorIndex(const std::vector<Mirror>& mirrors, const EmbreeScene& geometry);
  // Returns whether the mesh is flagged.
  bool is_mirror(uint32_t mesh_id) const { return mesh_id < of_mesh_.size() && of_mesh_[mesh_id] != kNone; }
  // Returns the index of the mirror that the triangle is a part of; -1 for other meshes.
  int operator()(uint32_t mesh_id, uint32_t triangle_id) const {
    if (!is_mirror(mesh_id)) return kNone;
    const int mirror = of_mesh_[mesh_id];
    return mirror == kFaces ? of_triangle_[mesh_id][triangle_id] : mirror;
  }

 private:
  static constexpr int kNone = -1, kFaces = -2;
  std::vector<int> of_mesh_;                   // as far as mirrors go
  std::vector<std::vector<int>> of_triangle_;  // by mesh ID, of those with several faces
};

// Decides between TE and TM at a hit by the transmit polarisation (scalar mode). It is TE where the part of `polarization`
// across `direction` lies within 45 degrees of the normal of the plane of incidence. It is TM where the field would lie
// along the direction of travel: only bounces in the plane of the field turn a ray that way. The part across is the mean (of
// squares) before and behind the bounce: both ways through it have one mode, so that a ray over a mirror and a leg that is
// searched from its other end have the same coefficient.
PolarizationMode polarization_mode(const Vec3& polarization, const Vec3& direction, const Vec3& normal);

// Returns the sign that a flagged mirror's coefficient takes along `polarization` (scalar mode), for a wave that travels
// along `direction`. Fresnel's TM coefficient is that along p_i and p_r (em/surface/fresnel.h), of which one may point with
// the field and the other against it, as at a wall at right angles to the field, where TE and TM must meet at normal
// incidence. The sign is +1 for TE, which is the mode of conductors, too (mode_along).
double mirror_sign(PolarizationMode mode, const Vec3& polarization, const Vec3& direction, const Vec3& normal);

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

// Returns the response of a flagged mirror, whose gamma has mirror_sign; `normal` may be on either side.
SurfaceResponse respond_as_mirror(const SurfaceModel& model, const Vec3& polarization, const Vec3& direction,
                                  const Vec3& normal);

}  // namespace echopath
