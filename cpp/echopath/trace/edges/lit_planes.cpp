#include "echopath/trace/edges/lit_planes.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/geometry.h"
#include "echopath/record/hit_points.h"

namespace echopath {
namespace {

constexpr double kSlope = 2e-3;      // of the keys of planes that may be one
constexpr double kApart = 4.0;       // distances of the antennas by which what they light may differ
constexpr double kRaysBeside = 2.0;  // spacings of rays around a hit where others may have gone by

// The key of a direction and of its opposite are the same.
double slope_key(const Vec3& normal) { return std::abs(normal.dot(kSortingDirection)); }

}  // namespace

LitPlanes::LitPlanes(const Scene& scene, const EmbreeScene& geometry, double wavelength)
    : scene_(scene), geometry_(geometry), tolerance_(geometry.plane_tolerance(wavelength)) {}

bool LitPlanes::may_mirror(const Hit& hit) const {
  const Node& node = scene_.node_of(hit.mesh_id);
  return !node.deformation && !node.material->mirror && !node.material->is_sheet();
}

void LitPlanes::add_chains(const PathBlock& block) {
  std::vector<TriangleName> facets;
  for (const PathBlock::LitChain& chain : block.lit_chains) {
    const std::span<const Hit> hits(block.chain_hits.data() + chain.first, chain.count);
    if (!std::ranges::all_of(hits, [&](const Hit& hit) { return may_mirror(hit); })) continue;
    facets.clear();
    for (const Hit& hit : hits) facets.push_back({hit.mesh_id, hit.triangle_id});
    Boxes& boxes = chains_[facets];
    boxes.resize(hits.size());
    for (size_t k = 0; k < hits.size(); ++k) {
      const Vec3 point = hit_point(geometry_.corners(hits[k].mesh_id, hits[k].triangle_id), hits[k]);
      const Vec3 around = Vec3::Constant(kRaysBeside * double{chain.spacing});
      boxes[k].extend(point - around).extend(point + around);
    }
  }
}

void LitPlanes::find_planes() {
  for (const auto& [facets, boxes] : chains_) {
    for (const TriangleName& facet : facets) plane_of_facet_[facet] = -1;
  }
  for (auto& [facet, index] : plane_of_facet_) {
    const auto corners = geometry_.corners(facet.mesh_id, facet.triangle_id);
    const Vec3 normal = cross_of_sides(corners).normalized();
    index = plane_through(corners, normal);
    if (index >= 0) continue;
    index = static_cast<int>(planes_.size());
    planes_.push_back({corners[0], normal});
    const std::pair<double, int> key(slope_key(normal), index);
    by_slope_.insert(std::ranges::upper_bound(by_slope_, key), key);
  }
}

int LitPlanes::plane_through(std::span<const Vec3> points, const Vec3& normal) const {
  const double key = slope_key(normal);
  int found = -1;
  auto one = std::ranges::lower_bound(by_slope_, std::pair(key - kSlope, -1));
  for (; one != by_slope_.end() && one->first <= key + kSlope; ++one) {
    const Plane& plane = planes_[one->second];
    const auto lies_in = [&](const Vec3& point) { return std::abs(plane.height(point)) <= tolerance_; };
    const bool is_parallel = plane.normal.cross(normal).norm() < kSlope;
    if (is_parallel && std::ranges::all_of(points, lies_in) && (found < 0 || one->second < found)) found = one->second;
  }
  return found;
}

int LitPlanes::plane_of(const Hit& hit) const {
  if (!may_mirror(hit)) return -1;
  if (const auto known = plane_of_facet_.find({hit.mesh_id, hit.triangle_id}); known != plane_of_facet_.end())
    return known->second;
  const auto corners = geometry_.corners(hit.mesh_id, hit.triangle_id);
  return plane_through(corners, cross_of_sides(corners).normalized());
}

void LitPlanes::finish(double antenna_distance) {
  find_planes();
  Found there, back;
  const auto widened = [&](const Box& box) -> Box {
    const Vec3 around = Vec3::Constant(kApart * antenna_distance);
    return {box.min() - around, box.max() + around};
  };
  for (const auto& [facets, boxes] : chains_) {
    std::vector<int> planes;
    for (const TriangleName& facet : facets) planes.push_back(plane_of_facet_.at(facet));
    there[{{planes.begin(), planes.end() - 1}, planes.back()}].extend(boxes.back());
    for (size_t k = 0; k + 1 < planes.size(); ++k) {
      const std::vector<int> mirrors(planes.rbegin(), planes.rend() - static_cast<int64_t>(k) - 1);
      if (antenna_distance > 0) back[{mirrors, planes[k]}].extend(widened(boxes[k]));
    }
  }
  for (const auto& [ways, box] : there) back[ways].extend(widened(box));
  chains_.clear();
  from_transmitter_ = sorted(there);
  from_receiver_ = sorted(back);
}

std::vector<LitPlane> LitPlanes::sorted(const Found& found) {
  std::vector<LitPlane> out;
  for (const auto& [ways, box] : found) out.push_back({ways.first, ways.second, box});
  return out;
}

}  // namespace echopath
