#include "echopath/scene/readers/corner_normals.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

// Returns zero for what has no direction.
Vec3 unit_of(const Vec3& vector) {
  const double length = vector.stableNorm();
  return std::isfinite(length) && length > 0.0 ? Vec3(vector / length) : Vec3(Vec3::Zero());
}

}  // namespace

CornerNormals::CornerNormals(const Soup& soup) : soup_(soup) {
  for (uint32_t t = 0; t < soup.triangles.size(); ++t) {
    if (smoothing(t) == 0 || has_own(t)) continue;
    const Vec3 area = cross_of_sides(soup.vertices, soup.triangles[t]);
    for (const uint32_t vertex : soup.triangles[t]) {
      sums_.try_emplace(key(smoothing(t), vertex), Vec3::Zero()).first->second += area;
    }
  }
}

bool CornerNormals::are_given(const std::vector<uint32_t>& triangles) const {
  return std::ranges::any_of(triangles, [&](uint32_t t) { return smoothing(t) > 0 || has_own(t); });
}

std::array<Vec3, 3> CornerNormals::of(uint32_t triangle) const {
  const Vec3 facet = unit_of(cross_of_sides(soup_.vertices, soup_.triangles[triangle]));
  std::array<Vec3, 3> found = {facet, facet, facet};
  for (size_t k = 0; k < 3; ++k) {
    Vec3 normal = Vec3::Zero();
    if (has_own(triangle)) {
      normal = unit_of(soup_.normals[soup_.normal[triangle][k]]);
    } else if (smoothing(triangle) > 0) {
      normal = unit_of(sums_.at(key(smoothing(triangle), soup_.triangles[triangle][k])));
    }
    if (!normal.isZero()) found[k] = normal;
  }
  return found;
}

bool CornerNormals::has_own(uint32_t triangle) const {
  if (triangle >= soup_.normal.size()) return false;
  const Triangle& normal = soup_.normal[triangle];
  return std::ranges::none_of(normal, [](uint32_t index) { return index == kNoNormal; });
}

uint32_t CornerNormals::smoothing(uint32_t triangle) const {
  return soup_.smoothing.empty() ? 0 : soup_.smoothing[triangle];
}

}  // namespace echopath
