#pragma once
// Finds what part of a mirror the surfaces before it hide from the source of a frustum.
#include <vector>

#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/mirrors/mirrors.h"

namespace echopath {

// Returns the part of a convex polygon where normal.dot(p) >= offset (Sutherland, Hodgman 1974); it is empty where it is a
// mere line.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double offset);
// Clips `polygon` itself; `spare` is kept from call to call for its memory.
void clip(std::vector<Vec3>& polygon, const Vec3& normal, double offset, std::vector<Vec3>& spare);

// Returns the inward unit normals of the planes through `apex` and each edge of a convex polygon.
std::vector<Vec3> rims_of(const std::vector<Vec3>& polygon, const Vec3& apex);

// Describes where a frustum comes from: its antenna or its last mirror.
struct FrustumSource {
  Vec3 apex;                         // the antenna or its image
  const Vec3* lit_normal = nullptr;  // of the last mirror, unit, on the lit side; null for the antenna itself
  double offset = 0.0;               // of its plane
};

// Marks the meshes that cast shadows, by mesh ID; an empty vector stands for all meshes. The frusta do not depend on where
// the other meshes are.
using ShadowCasters = std::vector<bool>;

class FrustumShadows {
 public:
  FrustumShadows(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, ShadowCasters casters);
  // Shrinks `window`, a convex polygon on the mirror `target`, to a convex polygon that holds all that can be seen from the
  // source; it is empty where all is hidden. Parts of it may still be hidden: rays find that out. Shadows are taken away one
  // after the other, each of a whole mirror without holes or of the one triangle that was met.
  void shrink(const FrustumSource& source, const Mirror& target, std::vector<Vec3>& window) const;

 private:
  bool look(const FrustumSource& source, const Mirror& target, const Vec3& point, std::vector<Vec3>& occluder) const;
  bool meets(const Vec3& from, const Vec3& direction, double reach, bool is_on_surface, RayHit& met) const;

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  MirrorIndex mirror_of_;
  ShadowCasters casters_;
};

}  // namespace echopath
