#include "echopath/validity/surface/surface_walk.h"

#include <algorithm>
#include <cmath>

#include "echopath/scene/smooth/smooth.h"

namespace echopath {
namespace {

constexpr double kInside = -1e-9;    // barycentric: on an edge is inside
constexpr double kOverEdge = -0.05;  // barycentric: how far outside of a facet the point above its edge may lie
constexpr double kOnePlane = 1e-5;   // 1 - cosine between facets of one plane: 0.26 degrees
constexpr int kMaxCrossings = 128;   // triangles on the way

// Returns the barycentric coordinates of the point's projection, by corner.
Vec3 barycentric(const std::array<Vec3, 3>& corners, const Vec3& normal, const Vec3& point) {
  const Vec3 along = point - corners[0], edge_u = corners[1] - corners[0], edge_v = corners[2] - corners[0];
  const double scale = normal.squaredNorm();
  const double u = normal.dot(along.cross(edge_v)) / scale, v = normal.dot(edge_u.cross(along)) / scale;
  return {1.0 - u - v, u, v};
}

struct Crossing {
  uint32_t triangle = kNoTriangle;
  bool in_plane = false;
};

bool share_corner(const Triangle& a, const Triangle& b, const std::vector<Vec3>& vertices) {
  return std::ranges::any_of(
      a, [&](uint32_t i) { return std::ranges::any_of(b, [&](uint32_t j) { return vertices[i] == vertices[j]; }); });
}

}  // namespace

struct SurfaceWalk::Surface {
  const std::vector<Triangle>& triangles;
  const std::vector<std::array<uint32_t, 3>>& neighbours;
  const std::vector<Vec3>* normals;  // of vertices, at rest; null for meshes of facets

  std::array<Vec3, 3> corners(uint32_t t, const std::vector<Vec3>& vertices) const {
    return {vertices[triangles[t][0]], vertices[triangles[t][1]], vertices[triangles[t][2]]};
  }
  Vec3 cross(uint32_t t, const std::vector<Vec3>& vertices) const {
    const auto [a, b, c] = corners(t, vertices);
    return cross_of_sides(a, b, c);
  }
  bool is_smooth(uint32_t t, const std::vector<Vec3>& vertices) const {
    return normals && is_smooth_facet(cross(t, vertices).normalized(), corners(t, *normals));
  }
  bool is_one_plane(uint32_t a, uint32_t b, const std::vector<Vec3>& vertices) const {  // windings may differ
    return std::abs(cross(a, vertices).normalized().dot(cross(b, vertices).normalized())) > 1.0 - kOnePlane;
  }
  Crossing cross_toward(uint32_t at, const Vec3& weights, const std::vector<Vec3>& vertices) const;
};

// Crosses the edge that the point lies farthest behind, among those over which the surface goes on.
Crossing SurfaceWalk::Surface::cross_toward(uint32_t at, const Vec3& weights, const std::vector<Vec3>& vertices) const {
  const auto behind = [&](int side) { return weights[(side + 2) % 3]; };  // edge i faces corner i + 2
  std::array<int, 3> sides = {0, 1, 2};
  std::ranges::sort(sides, [&](int a, int b) { return behind(a) < behind(b); });
  for (const int side : sides) {
    const uint32_t next = neighbours[at][side];
    if (behind(side) >= kInside || next == kNoTriangle) continue;
    if (is_one_plane(at, next, vertices)) return {next, true};
    if (is_smooth(at, vertices) && is_smooth(next, vertices)) return {next, false};
  }
  return {};
}

SurfaceWalk::SurfaceWalk(const Scene& scene, const NormalsOfMeshes& smooth_normals)
    : scene_(scene), smooth_normals_(smooth_normals), surfaces_(scene.meshes().size()) {}

SurfaceWalk::~SurfaceWalk() = default;

const SurfaceWalk::Surface& SurfaceWalk::surface(uint32_t mesh_id) const {
  return *surfaces_[mesh_id].get([&] {
    const Mesh& mesh = *scene_.node_of(mesh_id).mesh;
    return std::make_unique<const Surface>(Surface{mesh.triangles(), mesh.neighbours(), smooth_normals_[mesh_id].get()});
  });
}

std::optional<SurfaceWalk::Spot> SurfaceWalk::find(uint32_t mesh_id, uint32_t triangle, const std::vector<Vec3>& vertices,
                                                   const Vec3& point) const {
  const Surface& over = surface(mesh_id);
  const auto spot = [&](uint32_t at, const Vec3& weights, bool in_plane) {
    const Vec3 inside = weights.cwiseMax(0.0) / weights.cwiseMax(0.0).sum();
    const bool is_near = in_plane || share_corner(over.triangles[at], over.triangles[triangle], vertices);
    return Spot{{mesh_id, at, static_cast<float>(inside[1]), static_cast<float>(inside[2])}, is_near};
  };
  uint32_t at = triangle, last = kNoTriangle;
  bool in_plane = true, turned_back = false;
  for (int step = 0; step < kMaxCrossings; ++step) {
    const Vec3 weights = barycentric(over.corners(at, vertices), over.cross(at, vertices), point);
    if (weights.minCoeff() >= kInside) return spot(at, weights, in_plane);
    const Crossing crossing = over.cross_toward(at, weights, vertices);
    if (crossing.triangle == kNoTriangle) return std::nullopt;
    // A point off the surface may lie outside of all the facets that meet at an edge or at a vertex.
    const bool turns_back = crossing.triangle == last, is_over_edge = turns_back || step + 1 == kMaxCrossings;
    if (is_over_edge && weights.minCoeff() > kOverEdge) return spot(at, weights, in_plane);
    if (turns_back && turned_back) return std::nullopt;  // it would go to and fro for ever
    turned_back = turns_back;
    in_plane = in_plane && crossing.in_plane;
    last = at;
    at = crossing.triangle;
  }
  return std::nullopt;
}

}  // namespace echopath
