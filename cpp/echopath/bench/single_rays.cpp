#include "echopath/bench/single_rays.h"

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {
namespace {

constexpr int64_t kRaysPerBlock = 4096;

// Holds the scene at one time, with an origin next to the first of the points.
struct PosedGeometry {
  PosedGeometry(const Scene& scene, double time, const std::vector<Vec3>& points, Job* job)
      : pose(scene, time),
        origin(EmbreeScene::origin_near(scene, pose, points.empty() ? Vec3(Vec3::Zero()) : points.front())),
        triangles(scene, pose, origin, job) {}
  PosedScene pose;
  Vec3 origin;
  EmbreeScene triangles;
};

template <class Query>
void for_each_ray(size_t count, Job* job, const Query& query) {
  parallel_for_chunks(static_cast<int64_t>(count), kRaysPerBlock, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) query(i);
  }, job);
}

}  // namespace

RayAnswers first_hits(const Scene& scene, double time, const std::vector<Vec3>& origins, const std::vector<Vec3>& directions,
                      Job* job) {
  require(origins.size() == directions.size(), "directions", "must be as many as origins, rows", directions.size());
  const PosedGeometry geometry(scene, time, origins, job);
  const size_t count = origins.size();
  RayAnswers found{std::vector(count, RayAnswers::kNoMesh), std::vector<uint32_t>(count), std::vector<double>(count),
                   std::vector<uint8_t>(count)};
  for_each_ray(count, job, [&](size_t i) {
    RayHit hit;
    const auto verdict = geometry.triangles.intersect(origins[i] - geometry.origin, directions[i].normalized(), hit);
    found.is_false[i] = verdict == EmbreeScene::Verdict::kFalseHit;
    if (verdict != EmbreeScene::Verdict::kHit) return;
    found.mesh_id[i] = hit.hit.mesh_id;
    found.triangle_id[i] = hit.hit.triangle_id;
    found.distance[i] = hit.distance;
  });
  return found;
}

std::vector<uint8_t> blocked_segments(const Scene& scene, double time, const std::vector<Vec3>& starts,
                                      const std::vector<Vec3>& ends, Job* job) {
  require(starts.size() == ends.size(), "ends", "must be as many as starts, rows", ends.size());
  const PosedGeometry geometry(scene, time, starts, job);
  std::vector<uint8_t> blocked(starts.size());
  for_each_ray(starts.size(), job, [&](size_t i) {
    blocked[i] = geometry.triangles.occluded(starts[i] - geometry.origin, ends[i] - geometry.origin);
  });
  return blocked;
}

}  // namespace echopath
