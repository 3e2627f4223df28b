// Errors of sums over scatterers of surfaces: against how much such sums scatter.
#include <gtest/gtest.h>

#include <vector>

#include "echopath/power/interval/triangle_points.h"
#include "echopath/trace/scatter/surface_points.h"

namespace echopath::test_triangle_points {
namespace {

Hit on(uint32_t mesh, uint32_t triangle) { return {mesh, triangle, 0.25f, 0.25f}; }

TEST(TrianglePoints, OfOnePowerAreAnEvenSetOnEachTriangle) {
  constexpr double kOfEven = 0.9;
  TrianglePoints points;
  for (int i = 0; i < 16; ++i) points.add(on(0, 0), 2.0);
  EXPECT_DOUBLE_EQ(points.variance(), kOfEven * 4.0 * 4.0);
  for (int i = 0; i < 16; ++i) points.add(on(0, 0), 2.0 * 64.0);  // dense and sparse parts are sets of their own
  EXPECT_DOUBLE_EQ(points.variance(), kOfEven * 4.0 * (4.0 + 4.0 * 64.0 * 64.0));
  for (uint32_t i = 1; i <= 9; ++i) points.add(on(1, i), 1.0);
  EXPECT_DOUBLE_EQ(points.variance(), kOfEven * (16.0 + 16.0 * 64.0 * 64.0 + 9.0));
  points.add(on(2, 0), 0.0);
  EXPECT_DOUBLE_EQ(points.variance(), kOfEven * (16.0 + 16.0 * 64.0 * 64.0 + 9.0));
}

// A square before the viewer, cut into triangles that have some points each, or less than one: each point stands for the
// same solid angle, so that their number is what scatters.
TEST(TrianglePoints, HoldTheErrorOfTheNumberOfPoints) {
  constexpr int kSeeds = 200;
  for (const int side : {1, 4, 30}) {
    double sum = 0.0, squares = 0.0, estimate = 0.0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
      std::vector<SurfacePoint> found;
      for (int k = 0; k < 2 * side * side; ++k) {
        const double step = 2.0 / side, y = -1.0 + step * (k / 2 % side), z = -1.0 + step * (k / 2 / side);
        const Vec3 low(20.0, y, z), high(20.0, y + step, z + step),
            other = k % 2 ? Vec3(20.0, y + step, z) : Vec3(20.0, y, z + step);
        add_surface_points(seed, {{0, static_cast<uint32_t>(k)}, 0, {low, high, other}}, {Vec3::Zero(), 5e4}, found);
      }
      TrianglePoints points;
      for (const SurfacePoint& point : found) points.add(on(0, point.on.triangle_id), 1.0);
      const auto count = static_cast<double>(found.size());
      sum += count / kSeeds;
      squares += count * count / kSeeds;
      estimate += points.variance() / kSeeds;
    }
    EXPECT_GT(sum, 400.0);
    EXPECT_GT(estimate, squares - sum * sum) << side;
  }
}

}  // namespace
}  // namespace echopath::test_triangle_points
