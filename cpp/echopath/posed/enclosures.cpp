#include "echopath/posed/enclosures.h"

#include <cmath>
#include <cstdint>

#include "echopath/base/constants.h"
#include "echopath/base/solid_angle.h"
#include "echopath/posed/bodies.h"

namespace echopath {
namespace {

constexpr double kWholeSphere = 0.99;  // of 4 pi sr; seams between the parts of a body may be open by less

bool encloses(const Scene& scene, const PosedScene& pose, const Body& body, const Vec3& eye) {
  if (!body.box.contains(eye)) return false;
  double angle = 0.0;
  for (const uint32_t id : body.meshes) {
    if (scene.node_of(id).material->is_sheet()) continue;
    const auto count = static_cast<uint32_t>(scene.node_of(id).mesh->triangles().size());
    for (uint32_t triangle = 0; triangle < count; ++triangle) angle += solid_angle(pose.world_triangle(id, triangle), eye);
  }
  return std::abs(angle) > kWholeSphere * 4.0 * kPi;
}

bool is_anything_outside(const std::vector<Body>& bodies, const Body& body) {
  for (const Body& other : bodies) {
    if (&other != &body && !body.box.contains(other.box)) return true;
  }
  return false;
}

}  // namespace

std::vector<Enclosure> enclosures(const Scene& scene, const PosedScene& pose, const std::vector<Body>& bodies,
                                  const Radar& radar) {
  const Transform world_from_radar = radar.world_from_radar(pose.time());
  std::vector<Enclosure> found;
  for (const bool of_receivers : {false, true}) {
    const std::vector<Antenna>& antennas = of_receivers ? radar.receivers : radar.transmitters;
    if (antennas.empty()) continue;
    const Vec3 eye = world_from_radar * antennas.front().position;
    for (const Body& body : bodies) {
      if (encloses(scene, pose, body, eye) && is_anything_outside(bodies, body)) found.push_back({body.node, of_receivers});
    }
  }
  return found;
}

}  // namespace echopath
