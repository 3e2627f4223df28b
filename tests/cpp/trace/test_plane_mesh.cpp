// Points of a flat mesh find their triangles.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "echopath/trace/geometry/plane_mesh.h"

namespace echopath::test_plane_mesh {
namespace {

using Corners = std::vector<std::array<Vec3, 3>>;

// A tilted rectangle of 2 * columns * rows triangles around an odd place, without the middle third.
struct HoledRectangle {
  static constexpr int kColumns = 30, kRows = 12;
  Vec3 origin{4.0, -7.0, 2.0}, along = Vec3(1.0, 2.0, 0.5), across = Vec3(-2.0, 1.0, 0.3);
  static bool is_hole(int column, int row) { return column >= 10 && column < 20 && row >= 4 && row < 8; }
  Vec3 at(double x, double y) const { return origin + x / kColumns * along + y / kRows * across; }
  Corners corners() const {
    Corners all;
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        if (is_hole(column, row)) continue;
        const Vec3 a = at(column, row), b = at(column + 1, row), c = at(column, row + 1), d = at(column + 1, row + 1);
        all.push_back({a, b, c});
        all.push_back({d, c, b});
      }
    }
    return all;
  }
};

constexpr double kSamePoint = 1e-6;  // m: u and v are in single precision

std::vector<uint32_t> numbers(size_t count) {
  std::vector<uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

TEST(PlaneMesh, HitsLieWhereTheyWereAsked) {
  const HoledRectangle mesh;
  const Corners corners = mesh.corners();
  const PlaneMesh plane(3, numbers(corners.size()), corners, mesh.along.cross(mesh.across).normalized());
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-0.1, 1.1);
  int num_found = 0, num_missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = uniform(random) * HoledRectangle::kColumns, y = uniform(random) * HoledRectangle::kRows;
    const bool is_inside = x > 0 && y > 0 && x < HoledRectangle::kColumns && y < HoledRectangle::kRows &&
                           !HoledRectangle::is_hole(static_cast<int>(x), static_cast<int>(y));
    const Vec3 point = mesh.at(x, y);
    const std::optional<Hit> hit = plane.locate(point);
    ASSERT_EQ(hit.has_value(), is_inside) << x << " " << y;
    if (!hit) {
      ++num_missed;
      continue;
    }
    ++num_found;
    const auto& [a, b, c] = corners[hit->triangle_id];
    EXPECT_EQ(hit->mesh_id, 3u);
    EXPECT_LT((a + double{hit->u} * (b - a) + double{hit->v} * (c - a) - point).norm(), kSamePoint);
  }
  EXPECT_GT(num_found, 5000);
  EXPECT_GT(num_missed, 5000);
}

// Corners and edges belong to some triangle, however the rounding falls.
TEST(PlaneMesh, HasNoCracks) {
  const HoledRectangle mesh;
  const PlaneMesh plane(0, numbers(mesh.corners().size()), mesh.corners(), mesh.along.cross(mesh.across).normalized());
  for (int i = 0; i <= 4 * HoledRectangle::kColumns; ++i) {
    for (int row = 0; row <= HoledRectangle::kRows; ++row) {
      EXPECT_TRUE(plane.locate(mesh.at(0.25 * i, row)) || (row > 4 && row < 8));
    }
  }
}

TEST(PlaneMesh, TrianglesWithoutAreaHoldNoPoint) {
  const Vec3 a(0, 0, 0), b(1, 0, 0);
  EXPECT_FALSE(PlaneMesh(0, {0}, {{a, b, Vec3(0.5 * (a + b))}}, Vec3::UnitZ()).locate(Vec3(0.5, 0, 0)));
  EXPECT_FALSE(PlaneMesh(0, {}, {}, Vec3::UnitZ()).locate(a));
}

}  // namespace
}  // namespace echopath::test_plane_mesh
