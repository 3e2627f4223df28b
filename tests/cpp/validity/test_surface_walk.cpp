#include "echopath/validity/surface/surface_walk.h"

#include <gtest/gtest.h>

#include <utility>

#include "cpp/support/scenes.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath::test_surface_walk {
namespace {

using namespace testing;

constexpr double kSinglePrecision = 1e-6;  // of barycentric coordinates

struct Walker {
  Scene scene;
  NormalsOfMeshes normals;

  void add(const Surface& surface, bool smooth) {
    Node node = node_with("surface", surface, share(Material::metal()), smooth);
    scene.add(node);
    normals = {nullptr};
    if (!smooth) return;
    normals = {std::make_shared<const std::vector<Vec3>>(vertex_normals(node.mesh->vertices(), node.mesh->triangles()))};
  }
  const Mesh& mesh() const { return *scene.node_of(0).mesh; }
  std::optional<SurfaceWalk::Spot> walk(uint32_t triangle, const Vec3& point) const {
    return SurfaceWalk(scene, normals).find(0, triangle, mesh().vertices(), point);
  }
  Vec3 place(const Hit& hit) const {
    const Triangle& t = mesh().triangles()[hit.triangle_id];
    const std::vector<Vec3>& p = mesh().vertices();
    return p[t[0]] + hit.u * (p[t[1]] - p[t[0]]) + hit.v * (p[t[2]] - p[t[0]]);
  }
};

// Cells of 1 m in two triangles each, `count` a side; `bend`: height of the middle line x = count / 2.
Surface grid(uint32_t count, double bend) {
  Surface surface;
  for (uint32_t x = 0; x <= count; ++x) {
    for (uint32_t y = 0; y <= count; ++y) {
      const double from_rim = std::min(x, count - x);
      surface.vertices.push_back({double(x), double(y), bend * from_rim});
      if (x == count || y == count) continue;
      const uint32_t a = x * (count + 1) + y, b = a + count + 1;
      surface.triangles.push_back({a, b, b + 1});
      surface.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return surface;
}

TEST(SurfaceWalk, FindsThePointOfAPlaneOverManyTriangles) {
  Walker walker;
  walker.add(grid(20, 0.0), false);
  const Vec3 point(17.3, 4.2, 0.0);
  const auto spot = walker.walk(0, point);
  ASSERT_TRUE(spot);
  EXPECT_TRUE(spot->is_near);
  EXPECT_LT((walker.place(spot->hit) - point).norm(), kSinglePrecision);
}

TEST(SurfaceWalk, GoesOverAPlaneOfBothWindings) {
  Surface surface = grid(4, 0.0);
  for (size_t t = 0; t < surface.triangles.size(); t += 2) std::swap(surface.triangles[t][0], surface.triangles[t][1]);
  Walker walker;
  walker.add(surface, false);
  const Vec3 point(2.7, 3.4, 0.0);
  const auto spot = walker.walk(0, point);
  ASSERT_TRUE(spot);
  EXPECT_TRUE(spot->is_near);
  EXPECT_LT((walker.place(spot->hit) - point).norm(), kSinglePrecision);
}

TEST(SurfaceWalk, EndsAtTheRim) {
  Walker walker;
  walker.add(grid(4, 0.0), false);
  EXPECT_TRUE(walker.walk(0, {3.9, 3.9, 0.0}));
  EXPECT_FALSE(walker.walk(0, {4.1, 2.0, 0.0}));
}

TEST(SurfaceWalk, EndsAtACreaseUnlessTheSurfaceIsSmooth) {
  Walker roof, round;
  roof.add(grid(4, 0.2), false);
  round.add(grid(4, 0.2), true);
  const Vec3 behind(2.7, 0.4, 0.26);
  EXPECT_FALSE(roof.walk(0, behind));
  EXPECT_TRUE(round.walk(0, behind));
}

TEST(SurfaceWalk, NearIsOneTriangleFurtherOnASmoothSurface) {
  Walker ball;
  ball.add(ellipsoid({0, 0, 0}, {1, 1, 1}, 4), true);
  const auto& t = ball.mesh().triangles()[0];
  const std::vector<Vec3>& p = ball.mesh().vertices();
  const Vec3 centre = ((p[t[0]] + p[t[1]] + p[t[2]]) / 3.0).normalized(), along = (p[t[1]] - p[t[0]]).normalized();
  const double edge = (p[t[1]] - p[t[0]]).norm();
  const auto near = ball.walk(0, (centre + edge * along).normalized());
  const auto far = ball.walk(0, (centre + 4 * edge * along).normalized());
  ASSERT_TRUE(near && far);
  EXPECT_TRUE(near->is_near);
  EXPECT_FALSE(far->is_near);
}

TEST(SurfaceWalk, APlaneBehindABendIsNotNear) {
  Walker round;
  round.add(grid(8, 0.2), true);
  const auto before = round.walk(0, {2.6, 0.4, 0.52}), behind = round.walk(0, {6.6, 0.4, 0.28});
  ASSERT_TRUE(before && behind);
  EXPECT_TRUE(before->is_near);
  EXPECT_FALSE(behind->is_near);
}

TEST(SurfaceWalk, FindsPointsOfTheSphereAboveEdgesAndVertices) {
  Walker ball;
  ball.add(ellipsoid({0, 0, 0}, {1, 1, 1}, 3), true);
  const std::vector<Vec3>& p = ball.mesh().vertices();
  for (uint32_t t = 0; t < 40; ++t) {  // no facet of a convex surface reaches under them
    const Triangle& corners = ball.mesh().triangles()[t];
    const Vec3 above_edge = (p[corners[0]] + p[corners[1]]).normalized(), above_vertex = 1.01 * p[corners[2]];
    for (const Vec3& point : {above_edge, above_vertex}) {
      const auto spot = ball.walk(t, point);
      ASSERT_TRUE(spot) << t;
      EXPECT_LT((ball.place(spot->hit).normalized() - point.normalized()).norm(), 2e-3);
    }
  }
}

}  // namespace
}  // namespace echopath::test_surface_walk
