// How far facets stray from a curved surface: against the volume between the two.
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"
#include "echopath/base/constants.h"
#include "echopath/power/interval/facet_phase.h"

namespace echopath::test_facet_phase {
namespace {

using namespace testing;

constexpr double kRadius = 0.4, kWavenumber = 1600.0;  // m, rad/m
constexpr double kSample = 0.03;                       // relative: of a part of the facets, which differ by a third

Node ball_of(const Surface& surface) {
  Node ball = node_with("ball", surface, share(Material::metal()), true);
  return ball;
}

// The volume between the sphere and its facets, over their area.
double mean_depth_of(const Mesh& mesh) {
  double volume = 4.0 / 3.0 * kPi * kRadius * kRadius * kRadius;
  for (const Triangle& t : mesh.triangles())
    volume -= mesh.vertices()[t[0]].dot(mesh.vertices()[t[1]].cross(mesh.vertices()[t[2]])) / 6.0;
  return volume / mesh.area();
}

double phase_of(Node node) {
  Scene scene;
  scene.add(std::move(node));
  return FacetPhases(scene, kWavenumber, 0.0).of(0);
}

TEST(FacetPhases, OfASphereIsTheVolumeThatItsFacetsLeaveOut) {
  for (const int subdivisions : {3, 4}) {
    const Node ball = ball_of(ellipsoid(Vec3::Zero(), Vec3::Constant(kRadius), subdivisions));
    const double expected = 2.0 * kWavenumber * mean_depth_of(*ball.mesh);
    EXPECT_NEAR(phase_of(ball) / expected, 1.0, kSample) << subdivisions;
  }
}

TEST(FacetPhases, GrowWithTheScaleOfABody) {
  Node ball = ball_of(ellipsoid(Vec3::Zero(), Vec3::Constant(kRadius), 3));
  const double at_rest = phase_of(ball);
  ball.placement.linear() *= 2.5;
  EXPECT_NEAR(phase_of(ball) / at_rest, 2.5, 1e-12);
  ball.placement.linear() *= -1.0;  // a reflection
  EXPECT_NEAR(phase_of(ball) / at_rest, 2.5, 1e-12);
}

TEST(FacetPhases, AreNothingForFacetsThatStandForThemselves) {
  Node ball = ball_of(ellipsoid(Vec3::Zero(), Vec3::Constant(kRadius), 1));
  ball.smooth = false;
  EXPECT_EQ(phase_of(ball), 0.0);
}

// The corners of an icosahedron lie beyond the crease guard.
TEST(FacetPhases, AreNothingBetweenCreases) {
  EXPECT_EQ(phase_of(ball_of(ellipsoid(Vec3::Zero(), Vec3::Constant(kRadius), 0))), 0.0);
}

}  // namespace
}  // namespace echopath::test_facet_phase
