#include "echopath/scene/edges/patch_sizes.h"

#include "echopath/base/memory/recent_results.h"
#include "echopath/scene/edges/planar_patches.h"
#include "echopath/scene/mesh/mesh_name.h"

namespace echopath {
namespace {

constexpr size_t kManyTriangles = 1 << 15;  // of which the planes take some 50 ms to find
constexpr size_t kMostKept = 8;

struct PlacedMesh {
  MeshName mesh;
  Mat3 linear;

  bool operator==(const PlacedMesh& other) const = default;
};

std::shared_ptr<const PatchSizes> measured(const Mesh& mesh, const Mat3& linear) {
  std::vector<Vec3> vertices = mesh.vertices();
  for (Vec3& vertex : vertices) vertex = linear * vertex;
  const std::vector<Triangle>& triangles = mesh.triangles();
  const double tolerance = flat_tolerance(box_about(vertices).diagonal().norm());
  const TriangleContacts contacts(vertices, triangles, tolerance);
  const auto patches = planar_patches(vertices, triangles, tolerance, contacts);
  std::vector<uint32_t> patch_of(triangles.size());
  for (uint32_t patch = 0; patch < patches.size(); ++patch) {
    for (const uint32_t triangle : patches[patch]) patch_of[triangle] = patch;
  }
  const auto sizes = std::make_shared<PatchSizes>();
  for (const std::vector<uint32_t>& patch : patches) {
    if (patch.size() == 1) continue;
    double twice_area = 0.0, rim = 0.0;
    for (const uint32_t triangle : patch) {
      const auto is_of_patch = [&](uint32_t other) { return patch_of[other] == patch_of[triangle]; };
      twice_area += cross_of_sides(vertices, triangles[triangle]).norm();
      rim += contacts.open_length(triangle, is_of_patch);
    }
    sizes->triangles.insert(sizes->triangles.end(), patch.begin(), patch.end());
    sizes->ends.push_back(static_cast<uint32_t>(sizes->triangles.size()));
    sizes->area.push_back(0.5 * twice_area);
    sizes->rim.push_back(rim);
  }
  return sizes;
}

}  // namespace

std::shared_ptr<const PatchSizes> patch_sizes(const MeshPtr& mesh, const Mat3& linear) {
  using Recent = RecentResults<PlacedMesh, std::shared_ptr<const PatchSizes>>;
  static Recent& known = *new Recent(kMostKept);  // never destroyed: threads may outlive what is static
  if (mesh->triangles().size() < kManyTriangles) return measured(*mesh, linear);
  return known.get({MeshName(mesh), linear}, [&] { return measured(*mesh, linear); });
}

}  // namespace echopath
