#include "echopath/scene/edges/planar_patches.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "echopath/base/plane.h"

namespace echopath {
namespace {

class PatchFinder {
 public:
  PatchFinder(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, double tolerance,
              const TriangleContacts& contacts)
      : vertices_(vertices), triangles_(triangles), tolerance_(tolerance), contacts_(contacts), is_taken_(triangles.size()) {
  }

  std::vector<std::vector<uint32_t>> find() {
    std::vector<std::vector<uint32_t>> patches;
    for (const uint32_t seed : by_area()) {
      if (!is_taken_[seed]) patches.push_back(grow(seed));
    }
    return patches;
  }

 private:
  std::vector<uint32_t> by_area() const {
    std::vector<double> areas;
    for (uint32_t t = 0; t < triangles_.size(); ++t) areas.push_back(cross_of_sides(vertices_, triangles_[t]).squaredNorm());
    std::vector<uint32_t> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, std::greater(), [&](uint32_t triangle) { return areas[triangle]; });
    return order;
  }

  // Small triangles tell a plane badly, so it is fitted anew to what has grown, as long as that grows further.
  std::vector<uint32_t> grow(uint32_t seed) {
    std::vector<uint32_t> patch = {seed};
    is_taken_[seed] = true;
    Plane plane = fitted_to(patch);
    for (size_t before = 0; before < patch.size();) {
      before = patch.size();
      for (size_t i = 0; i < patch.size(); ++i) {
        for (const uint32_t next : contacts_.touching(patch[i])) {
          if (is_taken_[next] || !lies_in(plane, next)) continue;
          is_taken_[next] = true;
          patch.push_back(next);
        }
      }
      const Plane fitted = fitted_to(patch);
      const bool holds_all = std::ranges::all_of(patch, [&](uint32_t t) { return lies_in(fitted, t); });
      if (!holds_all) break;
      plane = fitted;
    }
    std::ranges::sort(patch);
    return patch;
  }

  bool lies_in(const Plane& plane, uint32_t triangle) const {
    const Triangle& corners = triangles_[triangle];
    return std::ranges::all_of(corners,
                               [&](uint32_t corner) { return std::abs(plane.height(vertices_[corner])) <= tolerance_; });
  }

  // Returns the mean plane by area, whatever the windings.
  Plane fitted_to(const std::vector<uint32_t>& patch) const {
    const Vec3 reference = cross_of_sides(vertices_, triangles_[patch.front()]);
    Vec3 normal = Vec3::Zero(), middle = Vec3::Zero();
    double weight = 0.0;
    for (const uint32_t triangle : patch) {
      const Vec3 area = cross_of_sides(vertices_, triangles_[triangle]);
      const auto& [a, b, c] = triangles_[triangle];
      normal += area.dot(reference) < 0 ? Vec3(-area) : area;
      middle += area.norm() / 3.0 * (vertices_[a] + vertices_[b] + vertices_[c]);
      weight += area.norm();
    }
    return {middle / weight, normal.normalized()};
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  double tolerance_;
  const TriangleContacts& contacts_;
  std::vector<bool> is_taken_;
};

}  // namespace

std::vector<std::vector<uint32_t>> planar_patches(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                                  double tolerance) {
  return planar_patches(vertices, triangles, tolerance, TriangleContacts(vertices, triangles, tolerance));
}

std::vector<std::vector<uint32_t>> planar_patches(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                                  double tolerance, const TriangleContacts& contacts) {
  return PatchFinder(vertices, triangles, tolerance, contacts).find();
}

}  // namespace echopath
