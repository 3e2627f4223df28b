#pragma once
// Plates for tests of visibility, and what is seen of them.
#include <cmath>
#include <string>
#include <vector>

#include "cpp/support/scenes.h"
#include "echopath/label/objects/visibility.h"

namespace echopath::testing {

// Solid angle of the rectangle 0 <= y <= a, 0 <= z <= b at x = d, signed; seen from the origin.
inline double corner_angle(double a, double b, double d) {
  return std::atan(a * b / (d * std::sqrt(a * a + b * b + d * d)));
}

inline double rectangle_angle(double y0, double y1, double z0, double z1, double d) {
  return corner_angle(y1, z1, d) - corner_angle(y0, z1, d) - corner_angle(y1, z0, d) + corner_angle(y0, z0, d);
}

inline void add_facing(Scene& scene, const std::string& name, double x, double y0, double y1, double z0, double z1) {
  add_rectangle(scene, name, {x, y0, z0}, {0, y1 - y0, 0}, {0, 0, z1 - z0}, share(Material::metal()));
}

inline std::vector<ObjectVisibility> seen_in(const Scene& scene, const std::vector<std::string>& names,
                                             const Radar& radar = plain_radar(Vec3::Zero(), Vec3::Zero())) {
  std::vector<NamedGlobs> objects;
  for (const std::string& name : names) objects.push_back({name, {name}});
  return visibility(scene, radar, map_surfaces(scene, objects));
}

inline double occluded_by(const VisibilityFromEnd& seen, const std::string& name) {
  for (const auto& [occluder, share] : seen.occluders) {
    if (occluder == name) return share;
  }
  return 0.0;
}

}  // namespace echopath::testing
