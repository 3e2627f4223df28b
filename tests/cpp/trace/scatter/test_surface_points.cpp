// Points of a surface: the same whatever the density, as many as rays would meet, and evenly spread.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "echopath/trace/scatter/surface_points.h"

namespace echopath::test_surface_points {
namespace {

using Corners = std::array<Vec3, 3>;

constexpr uint64_t kSeed = 5;
constexpr uint32_t kMeshId = 5;  // another than the number of the mesh
const Corners kSlanted{Vec3(6, -2, -1), Vec3(9, 3, -1), Vec3(8, 0, 2)};

std::vector<SurfacePoint> points_of(const Corners& corners, double ray_density, uint32_t mesh_number = 3,
                                    uint32_t triangle_id = 11, uint64_t seed = kSeed) {
  std::vector<SurfacePoint> points;
  add_surface_points(seed, {{kMeshId, triangle_id}, mesh_number, corners}, {Vec3::Zero(), ray_density}, points);
  return points;
}

// Source: van Oosterom and Strackee 1983, the solid angle of a triangle seen from the origin, sr.
double solid_angle(const Corners& corners) {
  const Vec3 a = corners[0].normalized(), b = corners[1].normalized(), c = corners[2].normalized();
  return 2.0 * std::abs(std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a)));
}

// Returns the parts that halving all edges `levels` times makes.
std::vector<Corners> parts_of(const Corners& whole, int levels) {
  if (levels == 0) return {whole};
  const Vec3 a = 0.5 * (whole[1] + whole[2]), b = 0.5 * (whole[2] + whole[0]), c = 0.5 * (whole[0] + whole[1]);
  std::vector<Corners> parts;
  for (const Corners& part : {Corners{whole[0], c, b}, Corners{whole[1], a, c}, Corners{whole[2], b, a}, Corners{a, b, c}}) {
    const std::vector<Corners> inner = parts_of(part, levels - 1);
    parts.insert(parts.end(), inner.begin(), inner.end());
  }
  return parts;
}

bool is_within(const Corners& corners, const Vec3& point) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 &from = corners[k], &to = corners[(k + 1) % 3];
    if ((to - from).cross(point - from).dot(normal) < 0) return false;
  }
  return true;
}

int count_within(const Corners& corners, const std::vector<SurfacePoint>& points) {
  int count = 0;
  for (const SurfacePoint& point : points) count += is_within(corners, point.position);
  return count;
}

TEST(SurfacePoints, LieOnTheTriangleAndNoTwoShareAKey) {
  const auto points = points_of(kSlanted, 20000);
  ASSERT_GT(points.size(), 500u);
  std::map<int64_t, Vec3> by_key;
  const Vec3 normal = (kSlanted[1] - kSlanted[0]).cross(kSlanted[2] - kSlanted[0]).normalized();
  for (const SurfacePoint& point : points) {
    EXPECT_NEAR(normal.dot(point.position - kSlanted[0]), 0.0, 1e-12);
    EXPECT_TRUE(is_within(kSlanted, point.position));
    EXPECT_GE(point.key, 0);
    EXPECT_TRUE(by_key.emplace(point.key, point.position).second);
    EXPECT_EQ(point.on.mesh_id, kMeshId);
    EXPECT_EQ(point.on.triangle_id, 11u);
  }
}

TEST(SurfacePoints, OfFewerRaysAreAmongThoseOfMore) {
  std::map<int64_t, Vec3> many;
  for (const SurfacePoint& point : points_of(kSlanted, 3000)) many.emplace(point.key, point.position);
  const auto few = points_of(kSlanted, 1000);
  ASSERT_GT(few.size(), 20u);
  for (const SurfacePoint& point : few) {
    ASSERT_TRUE(many.contains(point.key));
    EXPECT_EQ(many[point.key], point.position);
  }
}

TEST(SurfacePoints, StayOnTheSurfaceThatMoves) {
  Corners moved = kSlanted;
  const Eigen::AngleAxisd turn(0.3, Vec3::UnitZ());
  for (Vec3& corner : moved) corner = turn * corner;
  const auto before = points_of(kSlanted, 2000), after = points_of(moved, 2000);  // the viewer sees as much of both
  ASSERT_EQ(before.size(), after.size());
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].key, after[i].key);
    EXPECT_NEAR((turn * before[i].position - after[i].position).norm(), 0.0, 1e-12);
  }
}

// A lattice of rays meets `ray_density` times the solid angle.
TEST(SurfacePoints, AreAsManyAsRaysWouldMeet) {
  const Corners near_plane{Vec3(-3, -4, -0.5), Vec3(40, 0, -0.5), Vec3(-3, 20, -0.5)};  // the foot of the viewer is on it
  for (const Corners& corners : {kSlanted, near_plane}) {
    for (const double wanted : {0.2, 7.0, 900.0}) {
      const int num_triangles = wanted < 1 ? 4000 : 40;
      double count = 0.0;
      for (int i = 0; i < num_triangles; ++i) {
        count +=
            static_cast<double>(points_of(corners, wanted / solid_angle(corners), 0, static_cast<uint32_t>(i), 77).size());
      }
      const double mean = count / num_triangles, deviation = std::sqrt(wanted / num_triangles);  // of Poisson's counts
      EXPECT_NEAR(mean, wanted, 3.0 * deviation);
    }
  }
}

TEST(SurfacePoints, AreEvenlySpread) {
  const Corners far{Vec3(1e4, 0, 0), Vec3(1e4, 1, 0), Vec3(1e4, 0.2, 1)};  // seen with one density
  const auto points = points_of(far, 4096 / solid_angle(far));
  EXPECT_NEAR(static_cast<double>(points.size()), 4096.0, 2.0);
  for (const Corners& part : parts_of(far, 3)) EXPECT_NEAR(count_within(part, points), 64, 1);  // chance leaves 8
}

TEST(SurfacePoints, FollowTheDensityOfTheRays) {
  const Corners road{Vec3(1, -2, -1), Vec3(1, 2, -1), Vec3(60, 0, -1)};
  const double ray_density = 20000;
  const auto points = points_of(road, ray_density);
  for (const Corners& part : parts_of(road, 2)) {
    const double wanted = ray_density * solid_angle(part);
    EXPECT_NEAR(count_within(part, points), wanted, 3.0 + 0.5 * std::sqrt(wanted)) << part[0].transpose();
  }
}

// Of a fine mesh every triangle has a point or none; neighbours have numbers in a row.
TEST(SurfacePoints, OfSmallTrianglesAreEvenAlongTheMesh) {
  const Corners small{Vec3(10, 0, 0), Vec3(10, 0.01, 0), Vec3(10, 0, 0.01)};
  const double each = 0.05;
  for (uint32_t first = 0; first < 4000; first += 200) {
    double count = 0.0;
    for (uint32_t i = first; i < first + 200; ++i) {
      count += static_cast<double>(points_of(small, each / solid_angle(small), 0, i).size());
    }
    EXPECT_NEAR(count, 10.0, 2.0) << first;  // chance leaves 3
  }
}

}  // namespace
}  // namespace echopath::test_surface_points
