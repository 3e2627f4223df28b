#pragma once
// This is the only header that knows Embree. Internal to the module and to `bench`, which looks at queries.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <limits>
#include <vector>

#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/embree/tree_shape.h"

namespace echopath {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
// A hit is close when it lies this near its ray, a few units of single precision. A larger distance comes from the rounding
// of (u, v): on a triangle 10 m long and 1 mm high it is up to a millimetre.
inline constexpr double kRoundedAbsolute = 1e-6;  // m
inline constexpr double kRoundedRelative = 5e-7;

template <class Real>
void set_ray(RTCRay& ray, const VectorOf<Real>& from, const VectorOf<Real>& direction, float far) {
  ray.org_x = static_cast<float>(from.x);
  ray.org_y = static_cast<float>(from.y);
  ray.org_z = static_cast<float>(from.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tnear = 0.0f;
  ray.tfar = far;
  ray.time = 0.0f;
  ray.mask = static_cast<uint32_t>(Sees::kOpaque);
  ray.id = 0;
  ray.flags = 0;
}

// Lanes that are not in use get numbers too, and an empty interval: without AVX-512 Embree looks at them whatever `valid`
// says.
template <class Real>
ECHOPATH_INLINE void set_ray(RTCRay16& rays, int lane, const VectorOf<Real>& from, const VectorOf<Real>& direction,
                             float far) {
  rays.org_x[lane] = static_cast<float>(from.x);
  rays.org_y[lane] = static_cast<float>(from.y);
  rays.org_z[lane] = static_cast<float>(from.z);
  rays.dir_x[lane] = static_cast<float>(direction.x);
  rays.dir_y[lane] = static_cast<float>(direction.y);
  rays.dir_z[lane] = static_cast<float>(direction.z);
  rays.tnear[lane] = 0.0f;
  rays.tfar[lane] = far;
  rays.time[lane] = 0.0f;
  rays.mask[lane] = static_cast<uint32_t>(Sees::kOpaque);
  rays.id[lane] = 0;
  rays.flags[lane] = 0;
}

inline void forget_hit(RTCHit& hit) {
  hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

inline void forget_hits(RTCHit16& hits) {
  for (int lane = 0; lane < kPacketSize; ++lane) {
    hits.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    hits.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
}

// Holds -1 for each lane of a packet that is in use, else 0.
struct alignas(64) ValidLanes {
  int lanes[kPacketSize];
};

// Tells whether the rays of a packet go through the tree of triangles together or each by itself, which is a tenth faster
// where each of them meets other triangles than the rest, as a small bundle does on a fine mesh.
enum class PacketWay { kTogether, kApart };

// Asks Embree, one ray or a packet at a time. It writes the closest hits of rays into the query; it marks an occluded ray
// with a far end of -infinity. Thread-safe.
class EmbreeScene::Queries {
 public:
  virtual ~Queries() = default;
  virtual void intersect(RTCRayHit& query) const = 0;
  virtual void intersect(const ValidLanes& valid, RTCRayHit16& packet, PacketWay way) const = 0;
  virtual void occluded(RTCRay& ray) const = 0;
  virtual void occluded(const ValidLanes& valid, RTCRay16& rays) const = 0;
};

// Holds Embree's scene. A geometry of it, named by an ID, is a mesh or a cluster of meshes.
struct EmbreeScene::Device final : EmbreeScene::Queries {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  bool has_tree_per_mesh = false;

  Device();
  ~Device() override;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  // Starts a scene with one tree over all triangles, or (`tree_per_mesh`) with one for each geometry and one over those:
  // then what moves costs a fit of its own tree and a new upper one. All follow from the triangles alone, however often
  // and from what they were built before.
  void start_scene(size_t num_ids, bool tree_per_mesh);
  // Sets a geometry to the mesh of that ID, which keeps its tree where it is the same mesh in much the same shape.
  void set_mesh(uint32_t mesh_id, const EmbreeMeshes& meshes);
  void set_cluster(uint32_t id, const EmbreeMeshes& meshes, const std::vector<uint32_t>& mesh_ids);
  void remove(uint32_t id);
  void build(const EmbreeMeshes& meshes, Job* job);

  void intersect(RTCRayHit& query) const override;
  void intersect(const ValidLanes& valid, RTCRayHit16& packet, PacketWay way) const override;
  void occluded(RTCRay& ray) const override;
  void occluded(const ValidLanes& valid, RTCRay16& rays) const override;

 private:
  struct Tree {
    RTCGeometry geometry = nullptr;       // the scene holds it; null where there is none
    const Triangle* triangles = nullptr;  // of the mesh; null for a cluster
    TreeShape shape;                      // in which it was grown
  };
  RTCGeometry new_geometry(size_t num_vertices, size_t num_triangles, const Triangle* shared) const;
  void attach(uint32_t id, RTCGeometry geometry);
  void commit(Job* job);
  void touch_any();
  void check(const char* what) const;

  std::vector<Tree> trees_;       // by ID
  std::vector<uint32_t> to_fit_;  // their trees are to be grown in another shape first
  size_t num_to_grow_ = 0;        // triangles whose trees are new
};

}  // namespace echopath
