#include "echopath/scene/coplanar.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/scene/facet_overlap.h"

namespace echopath {
namespace {

constexpr int64_t kTrianglesPerBlock = 2048;

// The triangles of a scene at one time, in m about one of their corners.
struct PosedTriangles {
  std::vector<Corners> corners;
  std::vector<uint32_t> mesh_id;
};

// One triangle laid on another; both by place, the first of the mesh with the lower ID.
struct Laid {
  uint32_t first_mesh_id, second_mesh_id, first, second;
  FacetOverlap overlap;
  std::pair<uint32_t, uint32_t> meshes() const { return {first_mesh_id, second_mesh_id}; }
};

bool has_area(const Corners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).squaredNorm() > 0.0;
}

PosedTriangles pose_triangles(const Scene& scene, double time, const Job* job) {
  PosedTriangles posed;
  const auto count = static_cast<size_t>(scene.num_triangles());
  posed.corners.reserve(count);
  posed.mesh_id.reserve(count);
  Vec3 origin = Vec3::Zero();
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    if (job) job->throw_if_cancelled();
    const std::vector<Vec3> vertices = world_vertices(scene, id, time);
    if (id == 0) origin = vertices.front();
    for (const Triangle& t : scene.node_of(id).mesh->triangles()) {
      const Corners corners = {vertices[t[0]] - origin, vertices[t[1]] - origin, vertices[t[2]] - origin};
      if (!has_area(corners)) continue;  // a deformation may take it
      posed.corners.push_back(corners);
      posed.mesh_id.push_back(id);
    }
  }
  return posed;
}

class OverlapSearch {
 public:
  OverlapSearch(const Scene& scene, double time, double max_distance, const Job* job)
      : OverlapSearch(pose_triangles(scene, time, job), max_distance, job) {}

  // All pairs, in an order that threads do not change.
  std::vector<Laid> run(Job* job) const {
    const auto count = static_cast<int64_t>(tree_.size());
    std::vector<std::vector<Laid>> found(static_cast<size_t>((count + kTrianglesPerBlock - 1) / kTrianglesPerBlock));
    if (job) job->start(static_cast<int64_t>(found.size()));
    parallel_for(static_cast<int64_t>(found.size()), [&](int64_t block) {
      const int64_t end = std::min((block + 1) * kTrianglesPerBlock, count);
      for (int64_t place = block * kTrianglesPerBlock; place < end; ++place) {
        search_behind(static_cast<uint32_t>(place), found[static_cast<size_t>(block)]);
      }
    }, job);
    std::vector<Laid> all;
    for (const std::vector<Laid>& of_block : found) all.insert(all.end(), of_block.begin(), of_block.end());
    return all;
  }

 private:
  OverlapSearch(const PosedTriangles& posed, double max_distance, const Job* job)
      : tree_(posed.corners, job), mesh_id_(posed.mesh_id), max_distance_(max_distance) {}

  void search_behind(uint32_t place, std::vector<Laid>& found) const {
    const FacetPlane plane(tree_.triangle(place));
    tree_.visit_behind(
        place, [&](const Box& box) { return plane.may_meet(box, max_distance_); },
        [&](uint32_t other) {
          const auto overlap = plane.overlap(tree_.triangle(other), max_distance_);
          if (overlap) found.push_back(laid(place, other, *overlap));
        });
  }

  Laid laid(uint32_t one, uint32_t two, const FacetOverlap& overlap) const {
    const uint32_t mesh_of_one = mesh_id_[tree_.given(one)], mesh_of_two = mesh_id_[tree_.given(two)];
    if (mesh_of_two < mesh_of_one) return {mesh_of_two, mesh_of_one, two, one, overlap};
    return {mesh_of_one, mesh_of_two, one, two, overlap};
  }

  BoxTree tree_;
  std::vector<uint32_t> mesh_id_;
  double max_distance_;
};

// How many triangles the pairs speak of.
int64_t count_triangles(const Laid* begin, const Laid* end) {
  std::vector<uint32_t> places;
  for (const Laid* pair = begin; pair != end; ++pair) {
    places.push_back(pair->first);
    places.push_back(pair->second);
  }
  std::sort(places.begin(), places.end());
  return std::unique(places.begin(), places.end()) - places.begin();
}

CoplanarOverlap summed(const Laid* begin, const Laid* end) {
  CoplanarOverlap sum{begin->first_mesh_id, begin->second_mesh_id, count_triangles(begin, end)};
  for (const Laid* pair = begin; pair != end; ++pair) {
    sum.area += pair->overlap.area;
    sum.distance = std::max(sum.distance, pair->overlap.distance);
  }
  return sum;
}

}  // namespace

std::vector<CoplanarOverlap> coplanar_overlaps(const Scene& scene, double time, double max_distance, Job* job) {
  require(max_distance > 0.0 && std::isfinite(max_distance), "max_distance", "must be positive and finite, m", max_distance);
  require(scene.num_triangles() < int64_t{1} << 31, "scene", "must have fewer than 2^31 triangles", scene.num_triangles());
  if (scene.num_triangles() == 0) return {};
  std::vector<Laid> pairs = OverlapSearch(scene, time, max_distance, job).run(job);
  std::stable_sort(pairs.begin(), pairs.end(), [](const Laid& a, const Laid& b) { return a.meshes() < b.meshes(); });
  std::vector<CoplanarOverlap> overlaps;
  for (const Laid *begin = pairs.data(), *end = begin + pairs.size(); begin != end;) {
    const Laid* next = std::find_if(begin, end, [begin](const Laid& pair) { return pair.meshes() != begin->meshes(); });
    overlaps.push_back(summed(begin, next));
    begin = next;
  }
  return overlaps;
}

}  // namespace echopath
