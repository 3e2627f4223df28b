#include "echopath/scene/overlap/coplanar.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/scene/overlap/facet_overlap.h"

namespace echopath {
namespace {

constexpr int64_t kTrianglesPerBlock = 2048;
constexpr uint32_t kTrianglesOfLeaf = 4;

// Holds the triangles of a scene at one time, mesh after mesh, in m relative to one of their corners.
struct PosedTriangles {
  std::vector<Corners> corners;
  std::vector<uint32_t> mesh_id;
  std::vector<size_t> begin = {0};  // place of the first triangle of each mesh, and their number
};

// Describes one triangle laid on another. Both are given by place, and the first belongs to the mesh with the lower ID.
struct OverlapPair {
  uint32_t first_mesh_id, second_mesh_id, first, second;
  FacetOverlap overlap;
  std::pair<uint32_t, uint32_t> meshes() const { return {first_mesh_id, second_mesh_id}; }
};

double triangle_area(const Corners& corners) { return 0.5 * cross_of_sides(corners).norm(); }

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
      if (triangle_area(corners) == 0.0) continue;  // a deformation may flatten a triangle
      posed.corners.push_back(corners);
      posed.mesh_id.push_back(id);
    }
    posed.begin.push_back(posed.corners.size());
  }
  return posed;
}

// Returns for each mesh the first mesh whose triangles are the same to the bit and in the same order, which may be itself.
std::vector<uint32_t> find_originals(const PosedTriangles& posed) {
  std::unordered_map<std::string_view, uint32_t> first_of;
  std::vector<uint32_t> original;
  for (uint32_t id = 0; id + 1 < posed.begin.size(); ++id) {
    const size_t num_bytes = (posed.begin[id + 1] - posed.begin[id]) * sizeof(Corners);
    const std::string_view bytes(reinterpret_cast<const char*>(posed.corners.data() + posed.begin[id]), num_bytes);
    original.push_back(first_of.try_emplace(bytes, id).first->second);
  }
  return original;
}

// Returns the triangles of the meshes that are not copies.
PosedTriangles without_copies(const PosedTriangles& posed, const std::vector<uint32_t>& original) {
  PosedTriangles kept;
  for (size_t k = 0; k < posed.corners.size(); ++k) {
    if (original[posed.mesh_id[k]] != posed.mesh_id[k]) continue;
    kept.corners.push_back(posed.corners[k]);
    kept.mesh_id.push_back(posed.mesh_id[k]);
  }
  return kept;
}

class OverlapSearch {
 public:
  OverlapSearch(const PosedTriangles& posed, double max_distance, const Job* job)
      : tree_(static_cast<uint32_t>(posed.corners.size()), [&](uint32_t i) { return box_about(posed.corners[i]); },
              kTrianglesOfLeaf, job),
        max_distance_(max_distance) {
    triangles_.reserve(tree_.size());
    mesh_id_.reserve(tree_.size());
    for (uint32_t place = 0; place < tree_.size(); ++place) {
      triangles_.push_back(posed.corners[tree_.input_index(place)]);
      mesh_id_.push_back(posed.mesh_id[tree_.input_index(place)]);
    }
  }

  // Returns all pairs, in an order that does not depend on the threads.
  std::vector<OverlapPair> run(Job* job) const {
    const auto count = std::ssize(tree_);
    std::vector<std::vector<OverlapPair>> found(num_chunks(count, kTrianglesPerBlock));
    if (job) job->start(std::ssize(found));
    parallel_for_chunks(count, kTrianglesPerBlock, [&](int64_t begin, int64_t end) {
      std::vector<OverlapPair>& of_block = found[begin / kTrianglesPerBlock];
      for (int64_t place = begin; place < end; ++place) search_behind(static_cast<uint32_t>(place), of_block);
    }, job);
    std::vector<OverlapPair> all;
    for (const std::vector<OverlapPair>& of_block : found) all.insert(all.end(), of_block.begin(), of_block.end());
    return all;
  }

 private:
  void search_behind(uint32_t place, std::vector<OverlapPair>& found) const {
    const FacetPlane plane(triangles_[place]);
    const auto may_hold = [&](uint32_t index) {
      const BoxTree::Branch& branch = tree_.branches()[index];
      return branch.end > place + 1 && plane.may_meet(branch.box, max_distance_);
    };
    tree_.walk(may_hold, [&](const BoxTree::Branch& leaf) {
      for (uint32_t other = std::max(leaf.begin, place + 1); other < leaf.end; ++other) {
        if (!plane.may_meet(box_about(triangles_[other]), max_distance_)) continue;
        const auto overlap = plane.overlap(triangles_[other], max_distance_);
        if (overlap) found.push_back(overlap_pair(place, other, *overlap));
      }
      return true;
    });
  }

  OverlapPair overlap_pair(uint32_t one, uint32_t two, const FacetOverlap& overlap) const {
    const uint32_t mesh_of_one = mesh_id_[one], mesh_of_two = mesh_id_[two];
    if (mesh_of_two < mesh_of_one) return {mesh_of_two, mesh_of_one, two, one, overlap};
    return {mesh_of_one, mesh_of_two, one, two, overlap};
  }

  BoxTree tree_;
  std::vector<Corners> triangles_;  // by place in the tree, as mesh_id_
  std::vector<uint32_t> mesh_id_;
  double max_distance_;
};

// Counts the different triangles in a range of pairs.
int64_t count_triangles(const OverlapPair* begin, const OverlapPair* end) {
  std::vector<uint32_t> places;
  for (const OverlapPair* pair = begin; pair != end; ++pair) {
    places.push_back(pair->first);
    places.push_back(pair->second);
  }
  std::ranges::sort(places);
  return std::unique(places.begin(), places.end()) - places.begin();
}

CoplanarOverlap summed(const OverlapPair* begin, const OverlapPair* end) {
  CoplanarOverlap sum{begin->first_mesh_id, begin->second_mesh_id, count_triangles(begin, end)};
  for (const OverlapPair* pair = begin; pair != end; ++pair) {
    sum.area += pair->overlap.area;
    sum.distance = std::max(sum.distance, pair->overlap.distance);
  }
  return sum;
}

// Sums the overlaps of all pairs of triangles, for each pair of meshes.
std::vector<CoplanarOverlap> summed_by_meshes(std::vector<OverlapPair> pairs) {
  std::ranges::stable_sort(pairs, {}, &OverlapPair::meshes);
  std::vector<CoplanarOverlap> overlaps;
  for (const OverlapPair *begin = pairs.data(), *end = begin + pairs.size(); begin != end;) {
    const auto is_other = [begin](const OverlapPair& pair) { return pair.meshes() != begin->meshes(); };
    const OverlapPair* next = std::find_if(begin, end, is_other);
    overlaps.push_back(summed(begin, next));
    begin = next;
  }
  return overlaps;
}

// Describes a mesh and its copy: each triangle lies on its own copy, and two that lie on each other lie on each other's
// copies.
CoplanarOverlap of_copy(const PosedTriangles& posed, uint32_t original, uint32_t copy, const CoplanarOverlap* on_itself) {
  const size_t begin = posed.begin[copy], end = posed.begin[copy + 1];
  CoplanarOverlap found{original, copy, 2 * static_cast<int64_t>(end - begin)};
  for (size_t k = begin; k < end; ++k) found.area += triangle_area(posed.corners[k]);
  if (on_itself) {
    found.area += 2.0 * on_itself->area;
    found.distance = on_itself->distance;
  }
  return found;
}

std::vector<CoplanarOverlap> of_copies(const PosedTriangles& posed, const std::vector<uint32_t>& original,
                                       const std::vector<CoplanarOverlap>& overlaps) {
  std::unordered_map<uint32_t, const CoplanarOverlap*> on_itself;
  for (const CoplanarOverlap& one : overlaps) {
    if (one.first_mesh_id == one.second_mesh_id) on_itself[one.first_mesh_id] = &one;
  }
  std::vector<CoplanarOverlap> found;
  for (uint32_t copy = 0; copy < original.size(); ++copy) {
    if (original[copy] == copy || posed.begin[copy] == posed.begin[copy + 1]) continue;
    const auto own = on_itself.find(original[copy]);
    found.push_back(of_copy(posed, original[copy], copy, own == on_itself.end() ? nullptr : own->second));
  }
  return found;
}

}  // namespace

std::vector<CoplanarOverlap> coplanar_overlaps(const Scene& scene, double time, double max_distance, Job* job) {
  require(max_distance > 0.0 && std::isfinite(max_distance), "max_distance", "must be positive and finite, m", max_distance);
  require(scene.num_triangles() < int64_t{1} << 31, "scene", "must have fewer than 2^31 triangles", scene.num_triangles());
  if (scene.num_triangles() == 0) return {};
  const PosedTriangles posed = pose_triangles(scene, time, job);
  const std::vector<uint32_t> original = find_originals(posed);
  std::vector<CoplanarOverlap> overlaps =
      summed_by_meshes(OverlapSearch(without_copies(posed, original), max_distance, job).run(job));
  const std::vector<CoplanarOverlap> copies = of_copies(posed, original, overlaps);
  overlaps.insert(overlaps.end(), copies.begin(), copies.end());
  std::ranges::sort(overlaps, [](const CoplanarOverlap& a, const CoplanarOverlap& b) {
    return std::pair(a.first_mesh_id, a.second_mesh_id) < std::pair(b.first_mesh_id, b.second_mesh_id);
  });
  return overlaps;
}

}  // namespace echopath
