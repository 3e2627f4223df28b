#include "echopath/posed/enclosures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "echopath/base/constants.h"
#include "echopath/base/solid_angle.h"

namespace echopath {
namespace {

constexpr double kWholeSphere = 0.99;  // of 4 pi sr; seams between the parts of a body may be open by less

// Returns the solid angles that the triangles of a mesh fill, seen from `eye`; those that face it the other way count
// negative.
double angle_of(const Scene& scene, const PosedScene& pose, uint32_t mesh, const Vec3& eye) {
  if (scene.node_of(mesh).material->is_sheet()) return 0.0;
  const auto count = static_cast<uint32_t>(scene.node_of(mesh).mesh->triangles().size());
  double angle = 0.0;
  for (uint32_t triangle = 0; triangle < count; ++triangle) angle += solid_angle(pose.world_triangle(mesh, triangle), eye);
  return angle;
}

bool is_whole_sphere(double angle) { return std::abs(angle) > kWholeSphere * 4.0 * kPi; }

bool is_anything_outside(const std::vector<Body>& bodies, const Box& box) {
  return std::ranges::any_of(bodies, [&](const Body& body) { return !box.contains(body.box); });
}

// Returns whether some other body or mesh is wholly beside the box of a mesh; a frame that reaches through a wall of its
// room is not.
bool is_anything_beside(const PosedScene& pose, const std::vector<Body>& bodies, const Body& of_mesh, const Box& box) {
  return std::ranges::any_of(of_mesh.meshes, [&](uint32_t id) { return !box.intersects(box_of(pose, id)); }) ||
         std::ranges::any_of(bodies, [&](const Body& body) { return &body != &of_mesh && !box.intersects(body.box); });
}

// Returns the node of what holds `eye`, -1: nothing. That is the body or, of a body of many things, as a room with its
// furniture, the one mesh.
int around(const Scene& scene, const PosedScene& pose, const std::vector<Body>& bodies, const Body& body, const Vec3& eye) {
  if (!body.box.contains(eye)) return -1;
  std::vector<double> angles;
  for (const uint32_t id : body.meshes) angles.push_back(angle_of(scene, pose, id, eye));
  if (is_whole_sphere(std::accumulate(angles.begin(), angles.end(), 0.0)) && is_anything_outside(bodies, body.box))
    return body.node;
  for (size_t i = 0; i < angles.size(); ++i) {
    const uint32_t id = body.meshes[i];
    if (is_whole_sphere(angles[i]) && is_anything_beside(pose, bodies, body, box_of(pose, id)))
      return scene.meshes()[id].node;
  }
  return -1;
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
      const int node = around(scene, pose, bodies, body, eye);
      if (node >= 0) found.push_back({node, of_receivers});
    }
  }
  return found;
}

}  // namespace echopath
