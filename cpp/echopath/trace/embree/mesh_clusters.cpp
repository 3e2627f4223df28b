#include "echopath/trace/embree/mesh_clusters.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

constexpr size_t kFewestMeshes = 256;        // in a scene: with fewer, the trees of all cost little
constexpr size_t kFewestInCluster = 8;       // meshes
constexpr uint32_t kTrianglesInCell = 2000;  // a tree over them takes 0.4 ms
constexpr double kLargeShare = 0.25;         // of the length of a cluster: a mesh that long would spoil its tree
constexpr int kBits = 21;                    // per axis of a place

struct PlacedMesh {
  uint64_t place;  // of the centre along a curve through the cells of the octree (Morton 1966)
  const SmallMesh* mesh;
};

// Puts two empty bits behind each bit.
uint64_t spread(uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

// The cube reaches from -length to length (a power of two) in each axis.
uint64_t place_in_cube(const Vec3& point, double length) {
  uint64_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = 0.5 + 0.5 * point[axis] / length;
    const auto cell = static_cast<uint64_t>(std::clamp(share * (1 << kBits), 0.0, (1 << kBits) - 1.0));
    place |= spread(cell) << axis;
  }
  return place;
}

std::vector<PlacedMesh> placed(const std::vector<SmallMesh>& meshes) {
  double farthest = 1.0;
  for (const SmallMesh& mesh : meshes) farthest = std::max(farthest, mesh.box.center().cwiseAbs().maxCoeff());
  const double length = std::exp2(std::ceil(std::log2(farthest)));
  std::vector<PlacedMesh> out;
  out.reserve(meshes.size());
  for (const SmallMesh& mesh : meshes) out.push_back({place_in_cube(mesh.box.center(), length), &mesh});
  std::ranges::sort(out, [](const PlacedMesh& a, const PlacedMesh& b) {
    return a.place != b.place ? a.place < b.place : a.mesh->mesh_id < b.mesh->mesh_id;
  });
  return out;
}

class Divider {
 public:
  using Place = std::vector<PlacedMesh>::const_iterator;

  // Divides the meshes of a cell in halves by `bit` of their places, and these by the bits behind it.
  void divide(Place begin, Place end, int bit) {
    if (end - begin < static_cast<std::ptrdiff_t>(kFewestInCluster)) return;
    uint64_t num_triangles = 0;
    for (Place i = begin; i != end; ++i) num_triangles += i->mesh->num_triangles;
    if (num_triangles <= kTrianglesInCell || bit < 0) return add(begin, end);
    const Place middle =
        std::partition_point(begin, end, [bit](const PlacedMesh& one) { return (one.place >> bit & 1) == 0; });
    divide(begin, middle, bit - 1);
    divide(middle, end, bit - 1);
  }

  std::vector<std::vector<uint32_t>> clusters;

 private:
  void add(Place begin, Place end) {
    Box box;
    for (Place i = begin; i != end; ++i) box.extend(i->mesh->box);
    const double most = kLargeShare * box.sizes().maxCoeff();
    std::vector<uint32_t> cluster;
    for (Place i = begin; i != end; ++i) {
      if (i->mesh->box.sizes().maxCoeff() <= most) cluster.push_back(i->mesh->mesh_id);
    }
    if (cluster.size() < kFewestInCluster) return;
    std::ranges::sort(cluster);
    clusters.push_back(std::move(cluster));
  }
};

}  // namespace

std::vector<std::vector<uint32_t>> clusters_of(const std::vector<SmallMesh>& meshes) {
  if (meshes.size() < kFewestMeshes) return {};
  const std::vector<PlacedMesh> sorted = placed(meshes);
  Divider divider;
  divider.divide(sorted.begin(), sorted.end(), 3 * kBits - 1);
  return std::move(divider.clusters);
}

}  // namespace echopath
