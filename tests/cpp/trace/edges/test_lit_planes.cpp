// Which planes light which, as rays found them, and the ways between edges and antennas over them.
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"
#include "echopath/trace/edges/lit_planes.h"
#include "echopath/trace/edges/plane_legs.h"

namespace echopath::test_lit_planes {
namespace {

using namespace testing;

constexpr double kWavelength = 4e-3;  // m
constexpr double kRounding = 1e-9;    // m: coordinates of single precision have no part in lengths
constexpr uint32_t kFloor = 0, kOtherFloor = 1, kWall = 2, kPane = 3;

MaterialPtr conductor() {
  Material material;
  material.conductor = true;
  return share(material);
}

MaterialPtr glass() {
  Material material;
  material.layers = {{0.004, {6.0, 0.0}}};
  return share(material);
}

// A floor z = 0 of two meshes that meet at x = 0, a wall at x = 4, and a pane before the wall.
Scene corner() {
  Scene scene;
  add_rectangle(scene, "floor", {-4, -4, 0}, {4, 0, 0}, {0, 8, 0}, conductor());
  add_rectangle(scene, "other_floor", {0, -4, 0}, {4, 0, 0}, {0, 8, 0}, conductor());
  add_rectangle(scene, "wall", {4, -4, 0}, {0, 8, 0}, {0, 0, 4}, conductor());
  add_rectangle(scene, "pane", {3, -4, 0}, {0, 8, 0}, {0, 0, 4}, glass());
  return scene;
}

// A ray that meets these meshes in turn.
void add_ray(PathBlock& block, std::initializer_list<uint32_t> meshes) {
  std::vector<Hit> hits;
  for (const uint32_t mesh : meshes) hits.emplace_back(mesh, 0u, 0.25f, 0.25f);
  block.add_lit_chain(static_cast<int>(hits.size()), 0.01);
  block.end_ray(hits.data());
}

// The planes that rays found to light each other: each list of meshes is a ray.
struct Lit {
  explicit Lit(std::initializer_list<std::initializer_list<uint32_t>> rays, double apart = 0.0) {
    PathBlock block;
    for (const auto& meshes : rays) add_ray(block, meshes);
    planes.add_chains(block);
    planes.finish(apart);
  }
  Scene scene = corner();
  PosedScene pose{scene, 0.0};
  EmbreeScene geometry{scene, pose, Vec3::Zero()};
  LitPlanes planes{scene, geometry, kWavelength};
};

TEST(LitPlanes, FacetsOfSeveralMeshesInOnePlaneAreOne) {
  const Lit lit({{kFloor, kWall}, {kOtherFloor, kWall}});
  EXPECT_EQ(lit.planes.planes().size(), 2u);
  ASSERT_EQ(lit.planes.from_transmitter().size(), 1u);  // the wall over the floor
  for (const LitPlane& one : lit.planes.from_transmitter()) {
    ASSERT_EQ(one.mirrors.size(), 1u);
    EXPECT_NE(one.mirrors.front(), one.plane);
  }
  EXPECT_EQ(lit.planes.plane_of({kFloor, 1, 0.3f, 0.3f}), lit.planes.plane_of({kOtherFloor, 0, 0.1f, 0.1f}));
}

TEST(LitPlanes, TheSameWaysAreFoundInAnyOrderOfTheRays) {
  const double apart = 0.1;  // m
  const Lit one({{kFloor, kWall}, {kWall, kFloor}}, apart), other({{kWall, kFloor}, {kFloor, kWall}}, apart);
  ASSERT_EQ(one.planes.from_receiver().size(), other.planes.from_receiver().size());
  for (size_t i = 0; i < one.planes.from_receiver().size(); ++i) {
    EXPECT_EQ(one.planes.from_receiver()[i].mirrors, other.planes.from_receiver()[i].mirrors);
    EXPECT_TRUE(one.planes.from_receiver()[i].box.isApprox(other.planes.from_receiver()[i].box));
  }
}

// Queries go through panes, so that no way over one can be followed: looking for them is lost work.
TEST(LitPlanes, PanesLightNothing) {
  const Lit lit({{kFloor, kPane}, {kPane, kFloor}});
  EXPECT_TRUE(lit.planes.planes().empty());
  EXPECT_TRUE(lit.planes.from_transmitter().empty());
  EXPECT_EQ(lit.planes.plane_of({kPane, 0, 0.1f, 0.1f}), -1);
}

// A floor that lights the wall.
struct WallOverFloor : Lit {
  WallOverFloor() : Lit({{kFloor, kWall}}) {}
  SbrSettings settings;
  PlaneLegFinder finder{scene, geometry, planes, settings};

  // Returns the way from a point on the wall over the floor to an antenna.
  std::optional<PlaneLeg> leg(const Vec3& point, const Vec3& antenna) const {
    const int floor = planes.plane_of({kFloor, 0, 0.1f, 0.1f}), wall = planes.plane_of({kWall, 0, 0.1f, 0.1f});
    int64_t num_queries = 0;
    return finder.find(point, -Vec3::UnitX(), antenna, {{floor}, wall, {}}, num_queries);
  }
};

// By the image of the antenna in the floor.
TEST(PlaneLegs, AWayOverAPlaneIsThatToTheImageOfTheAntenna) {
  const WallOverFloor lit;
  const Vec3 point(4.0 - 1e-3, 0.3, 2.0), antenna(-3.0, 0.1, 1.0), image(-3.0, 0.1, -1.0);
  const auto leg = lit.leg(point, antenna);
  ASSERT_TRUE(leg.has_value());
  EXPECT_NEAR(leg->length, (image - point).norm(), kRounding);
  EXPECT_NEAR((leg->to_antenna - (image - point).normalized()).norm(), 0.0, kRounding);
  const Vec3 met = point + point.z() / (point.z() + 1.0) * (image - point);
  EXPECT_NEAR((leg->bounces.front().position - met).norm(), 0.0, 1e-5);  // half a point aside
  EXPECT_NEAR((leg->at_antenna - (met - antenna).normalized()).norm(), 0.0, 1e-5);
  EXPECT_NEAR(std::abs(leg->gain), 1.0, 1e-9);  // a conductor mirrors all
  EXPECT_NEAR(leg->share, 1.0, 1e-9);
}

TEST(PlaneLegs, TheRimOfAPlaneMirrorsHalfAndWhatLiesBeyondNothing) {
  const WallOverFloor lit;
  const auto share_of = [&](double y) {  // of a way that meets the floor there: its rim is at y = 4
    const Vec3 point(4.0 - 1e-3, y, 1.0), antenna(-3.0, y, 1.0);
    const auto leg = lit.leg(point, antenna);
    return leg ? leg->share : 0.0;
  };
  EXPECT_DOUBLE_EQ(share_of(0.0), 1.0);
  EXPECT_NEAR(share_of(4.0), 0.5, 0.02);  // the cover of the zone at the rim is a half by area
  EXPECT_DOUBLE_EQ(share_of(4.1), 0.0);
}

}  // namespace
}  // namespace echopath::test_lit_planes
