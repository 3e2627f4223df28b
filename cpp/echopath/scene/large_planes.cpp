#include "echopath/scene/large_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "echopath/base/principal_box.h"
#include "echopath/em/surface/coherent_share.h"
#include "echopath/scene/edges/planar_patches.h"
#include "echopath/scene/mesh/direction_count.h"

namespace echopath {
namespace {

constexpr double kZones = 2.0;    // widths of the Fresnel zone from which on a plane is large
constexpr int kPlanesOfBody = 3;  // large ones, of what may be a body: a wall has its two sides
constexpr uint32_t kNoPatch = 0xFFFFFFFFu;

// Measures the planes of one mesh.
class PlaneMeasure {
 public:
  PlaneMeasure(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, const LargePlaneRule& rule)
      : vertices_(vertices), triangles_(triangles), rule_(rule) {}

  // Returns the triangles of MeshOfLargePlanes; nothing where the mesh is none.
  std::optional<std::vector<uint32_t>> find() const {
    const Box box = box_about(vertices_);
    const double extent = box.diagonal().norm();
    if (!(extent >= least_width_at(nearest_distance(box)))) return std::nullopt;  // most meshes are told by their boxes
    Sizes sizes = measured(flat_tolerance(extent));
    if (!are_large(sizes, box)) return std::nullopt;
    if (sizes.num_small <= rule_.most_small_planes) sizes.small.clear();
    std::ranges::sort(sizes.small);
    return std::move(sizes.small);
  }

 private:
  struct Sizes {
    double whole = 0.0, large = 0.0;  // m^2, of the mesh and of its large planes
    int num_large = 0, num_small = 0;
    std::vector<uint32_t> small;  // triangles of the small planes
    Vec3 normal = Vec3::UnitX();  // of the widest plane
  };

  bool are_large(const Sizes& sizes, const Box& box) const {
    const double longest = box.sizes().maxCoeff();
    const bool is_short = longest < rule_.least_extent;
    const bool is_as_vehicle = longest <= rule_.vehicle_length && depth_along(sizes.normal) <= rule_.vehicle_width;
    const bool may_be_body = (is_short || is_as_vehicle) && sizes.num_large >= kPlanesOfBody;
    const bool is_room = may_be_body && surrounds_antennas();
    if (may_be_body && !is_room) return false;
    const double least_share = is_short && !is_room ? rule_.least_area_of_short : rule_.least_area;
    return sizes.whole > 0.0 && sizes.large >= least_share * sizes.whole;
  }

  // Measures the planes, which are flat to within a tolerance in m.
  Sizes measured(double tolerance) const {
    const TriangleContacts contacts(vertices_, triangles_, tolerance);
    const auto patches = planar_patches(vertices_, triangles_, tolerance, contacts);
    std::vector<uint32_t> patch_of(triangles_.size(), kNoPatch);
    for (uint32_t patch = 0; patch < patches.size(); ++patch) {
      for (const uint32_t triangle : patches[patch]) patch_of[triangle] = patch;
    }
    Sizes found;
    double widest = 0.0;
    for (const std::vector<uint32_t>& patch : patches) {
      const double area = area_of(patch);
      found.whole += area;
      if (4.0 * area >= least_width_at(farthest_distance(patch)) * rim_of(patch, contacts, patch_of)) {
        found.large += area;
        ++found.num_large;
      } else {
        ++found.num_small;
        found.small.insert(found.small.end(), patch.begin(), patch.end());
      }
      if (area > widest) {
        widest = area;
        found.normal = normal_of(patch.front());
      }
    }
    return found;
  }

  // Returns whether an antenna stands in the box along the mesh's own axes and has more of the mesh around it than half of
  // all directions, as in a room and in no body that it sees from outside.
  bool surrounds_antennas() const {
    const PrincipalBox own = principal_box(vertices_);
    return std::ranges::any_of(rule_.antennas, [&](const Vec3& antenna) {
      return own.box.contains(own.coordinates(antenna)) && covers_half_from(antenna);
    });
  }

  // Returns whether triangles lie in more than half of all directions, whichever side they show. Solid angles that add up
  // would count the front and the back of a body both.
  bool covers_half_from(const Vec3& eye) const {
    DirectionCount count;
    for (const auto& [a, b, c] : triangles_) {
      count.add(vertices_[a] - eye, vertices_[b] - eye, vertices_[c] - eye);
      if (count.is_over_half()) return true;
    }
    return false;
  }

  // Returns the width in m from which on a plane is large, at a distance in m from the antennas.
  double least_width_at(double distance) const { return kZones * 2.0 * std::sqrt(rule_.wavelength * distance); }

  double nearest_distance(const Box& box) const {
    double nearest = INFINITY;
    for (const Vec3& antenna : rule_.antennas) nearest = std::min(nearest, box.exteriorDistance(antenna));
    return nearest;
  }

  double farthest_distance(const std::vector<uint32_t>& patch) const {
    double farthest = 0.0;
    for (const uint32_t triangle : patch) {
      for (const uint32_t corner : triangles_[triangle]) {
        for (const Vec3& antenna : rule_.antennas) farthest = std::max(farthest, (vertices_[corner] - antenna).norm());
      }
    }
    return farthest;
  }

  double area_of(const std::vector<uint32_t>& patch) const {
    double twice = 0.0;
    for (const uint32_t triangle : patch) twice += cross_of_sides(vertices_, triangles_[triangle]).norm();
    return 0.5 * twice;
  }

  Vec3 normal_of(uint32_t triangle) const { return cross_of_sides(vertices_, triangles_[triangle]).normalized(); }

  // Returns from where to where the mesh reaches along a direction, m.
  double depth_along(const Vec3& direction) const {
    double least = INFINITY, most = -INFINITY;
    for (const Vec3& vertex : vertices_) {
      least = std::min(least, vertex.dot(direction));
      most = std::max(most, vertex.dot(direction));
    }
    return most - least;
  }

  // Returns the length in m of the edges that lead out of the patch.
  static double rim_of(const std::vector<uint32_t>& patch, const TriangleContacts& contacts,
                       const std::vector<uint32_t>& patch_of) {
    double length = 0.0;
    for (const uint32_t triangle : patch) {
      const auto is_of_patch = [&](uint32_t other) { return patch_of[other] == patch_of[triangle]; };
      length += contacts.open_length(triangle, is_of_patch);
    }
    return length;
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  const LargePlaneRule& rule_;
};

// Returns whether a node is carried by a motion: what moves is a vehicle or a door, whose echo and label it would lose.
bool moves(const Scene& scene, const Node& node) {
  for (const Node* one = &node;; one = &scene.nodes()[one->parent]) {
    if (one->motion) return true;
    if (one->parent < 0) return false;
  }
}

bool may_be_mirror(const Scene& scene, const Node& node, const LargePlaneRule& rule) {
  const Material& material = *node.material;
  return !material.mirror && !material.is_sheet() && !node.smooth && !node.deformation && !moves(scene, node) &&
         coherent_share(material, rule.wavelength) >= rule.least_coherent;
}

}  // namespace

std::vector<MeshOfLargePlanes> meshes_of_large_planes(const Scene& scene, const LargePlaneRule& rule) {
  const std::vector<Transform> placed = world_from_nodes(scene, rule.time);
  std::vector<MeshOfLargePlanes> found;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    if (!may_be_mirror(scene, node, rule)) continue;
    std::vector<Vec3> vertices = node.mesh->vertices();
    for (Vec3& vertex : vertices) vertex = placed[scene.meshes()[id].node] * vertex;
    std::optional<std::vector<uint32_t>> small = PlaneMeasure(vertices, node.mesh->triangles(), rule).find();
    if (small) found.push_back({id, std::move(*small)});
  }
  return found;
}

bool is_cut_from_mirror(const Scene& scene, uint32_t mesh_id) {
  const Node& node = scene.node_of(mesh_id);
  if (node.parent < 0 || !node.mesh->whole()) return false;
  const Node& above = scene.nodes()[node.parent];
  return above.mesh && above.material->mirror && above.mesh->whole() == node.mesh->whole();
}

}  // namespace echopath
