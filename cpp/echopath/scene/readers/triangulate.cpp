#include "echopath/scene/readers/soup.h"

namespace echopath {
namespace {

// Returns twice the vector area (Newell), which is normal to the mean plane.
Vec3 polygon_normal(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners) {
  Vec3 normal = Vec3::Zero();
  const Vec3& origin = vertices[corners[0]];
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += (vertices[corners[i]] - origin).cross(vertices[corners[i + 1]] - origin);
  }
  return normal;
}

double turn(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) { return (b - a).cross(c - b).dot(normal); }

bool is_inside(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return turn(a, b, p, normal) >= 0.0 && turn(b, c, p, normal) >= 0.0 && turn(c, a, p, normal) >= 0.0;
}

// Returns whether corner i of the remaining polygon can be cut off: it turns inwards and no other corner lies in its
// triangle.
bool is_ear(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& rest, size_t i, const Vec3& normal) {
  const size_t n = rest.size();
  const uint32_t before = rest[(i + n - 1) % n], here = rest[i], after = rest[(i + 1) % n];
  const Vec3 &a = vertices[before], &b = vertices[here], &c = vertices[after];
  if (turn(a, b, c, normal) <= 0.0) return false;
  for (const uint32_t other : rest) {
    const bool is_corner = other == before || other == here || other == after;
    if (!is_corner && is_inside(vertices[other], a, b, c, normal)) return false;
  }
  return true;
}

bool is_convex(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners, const Vec3& normal) {
  const size_t n = corners.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec3 &a = vertices[corners[i]], &b = vertices[corners[(i + 1) % n]], &c = vertices[corners[(i + 2) % n]];
    if (turn(a, b, c, normal) < 0.0) return false;
  }
  return true;
}

void append_fan(const std::vector<uint32_t>& corners, std::vector<Triangle>& triangles) {
  for (size_t i = 1; i + 1 < corners.size(); ++i) triangles.push_back({corners[0], corners[i], corners[i + 1]});
}

}  // namespace

std::vector<Triangle> triangulate(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners) {
  std::vector<Triangle> triangles;
  if (corners.size() > 3) {
    const Vec3 normal = polygon_normal(vertices, corners);
    std::vector<uint32_t> rest = corners;
    if (!is_convex(vertices, corners, normal)) {
      for (size_t i = 0; rest.size() > 3 && i < rest.size();) {
        if (!is_ear(vertices, rest, i, normal)) {
          ++i;
          continue;
        }
        const size_t n = rest.size();
        triangles.push_back({rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
        i = 0;
      }
    }
    append_fan(rest, triangles);
    return triangles;
  }
  append_fan(corners, triangles);
  return triangles;
}

void Soup::add_polygon(const std::vector<uint32_t>& corners, uint32_t group_index) {
  for (const Triangle& triangle : triangulate(vertices, corners)) {
    triangles.push_back(triangle);
    face.push_back(num_faces);
    group.push_back(group_index);
  }
  ++num_faces;
}

}  // namespace echopath
