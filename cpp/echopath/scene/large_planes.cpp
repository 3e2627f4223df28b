#include "echopath/scene/large_planes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "echopath/base/principal_box.h"
#include "echopath/em/surface/coherent_share.h"
#include "echopath/scene/edges/patch_sizes.h"
#include "echopath/scene/mesh/direction_count.h"

namespace echopath {
namespace {

constexpr double kZones = 2.0;    // widths of the Fresnel zone from which on a plane is large
constexpr int kPlanesOfBody = 3;  // large ones, of what may be a body: a wall has its two sides

// Measures the planes of one mesh.
class PlaneMeasure {
 public:
  PlaneMeasure(const MeshPtr& mesh, const Transform& place, const LargePlaneRule& rule)
      : mesh_(mesh), linear_(place.linear()), vertices_(mesh->vertices()), triangles_(mesh->triangles()), rule_(rule) {
    for (Vec3& vertex : vertices_) vertex = place * vertex;
  }

  // Returns the triangles of MeshOfLargePlanes; nothing where the mesh is none.
  std::optional<std::vector<uint32_t>> find() const {
    const Box box = box_about(vertices_);
    const double least_width = least_width_at(nearest_distance(box));
    if (!(box.diagonal().norm() >= least_width)) return std::nullopt;  // most meshes are told by their boxes
    Sizes sizes = measured(least_width);
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
    double widest = 0.0;          // m^2, of the widest plane
    Vec3 normal = Vec3::UnitX();  // of this one
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

  // Measures the planes, of which large ones have some width (m) at least.
  Sizes measured(double least_width) const {
    const std::shared_ptr<const PatchSizes> planes = patch_sizes(mesh_, linear_);
    Sizes found;
    std::vector<uint8_t> is_of_several(triangles_.size());
    for (size_t plane = 0; plane < planes->ends.size(); ++plane) {
      const std::span<const uint32_t> triangles = planes->of_plane(plane);
      for (const uint32_t triangle : triangles) is_of_several[triangle] = 1;
      add(triangles, planes->area[plane], planes->rim[plane], least_width, found);
    }
    for (uint32_t triangle = 0; triangle < triangles_.size(); ++triangle) {
      if (is_of_several[triangle]) continue;
      const auto& [a, b, c] = triangles_[triangle];
      const double rim =
          (vertices_[b] - vertices_[a]).norm() + (vertices_[c] - vertices_[b]).norm() + (vertices_[a] - vertices_[c]).norm();
      add({&triangle, 1}, 0.5 * cross_of_sides(vertices_, triangles_[triangle]).norm(), rim, least_width, found);
    }
    return found;
  }

  // Adds a plane of an area in m^2 and a rim in m, which is large only where it is as wide as the least one.
  void add(std::span<const uint32_t> plane, double area, double rim, double least_width, Sizes& found) const {
    found.whole += area;
    if (4.0 * area >= least_width * rim && 4.0 * area >= least_width_at(farthest_distance(plane)) * rim) {
      found.large += area;
      ++found.num_large;
    } else {
      ++found.num_small;
      found.small.insert(found.small.end(), plane.begin(), plane.end());
    }
    if (area > found.widest) {
      found.widest = area;
      found.normal = normal_of(plane.front());
    }
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

  double farthest_distance(std::span<const uint32_t> patch) const {
    double farthest = 0.0;
    for (const uint32_t triangle : patch) {
      for (const uint32_t corner : triangles_[triangle]) {
        for (const Vec3& antenna : rule_.antennas) farthest = std::max(farthest, (vertices_[corner] - antenna).norm());
      }
    }
    return farthest;
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

  const MeshPtr& mesh_;
  Mat3 linear_;
  std::vector<Vec3> vertices_;  // m, world
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
    std::optional<std::vector<uint32_t>> small = PlaneMeasure(node.mesh, placed[scene.meshes()[id].node], rule).find();
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
