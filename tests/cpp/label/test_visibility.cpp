#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "cpp/label/plates.h"
#include "cpp/support/any_threads.h"
#include "cpp/support/scenes.h"
#include "echopath/label/objects/appearing.h"
#include "echopath/label/objects/visibility.h"
#include "echopath/trace/embree/kept_geometry.h"

namespace echopath::test_visibility {
namespace {

using namespace testing;

// Of a share, for 4096 directions on a compact outline. 24 plates behind screens at random had 4e-4 rms, 9e-4 at most.
constexpr double kShareError = 2e-3;  // of a share: 4096 directions over a stratum a little wider than the object
constexpr double kAngleError = 3e-3;  // relative: all of the outline cuts cells of the lattice
// Of a share of an object that fills 2 % of its cone, for the 1400 directions on it after refinement; 90 before.
constexpr double kThinShareError = 3e-3;
constexpr double kRounding = 1e-12;  // m
constexpr double kSum = 1e-15;       // of some shares

void add_disc(Scene& scene, const std::string& name, double x, double radius) {
  constexpr int kSides = 256;  // area short of the circle's by 1e-4
  std::vector<Vec3> vertices{{x, 0, 0}};
  std::vector<Triangle> triangles;
  for (uint32_t k = 0; k < kSides; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSides;
    vertices.emplace_back(x, radius * std::cos(angle), radius * std::sin(angle));
    triangles.push_back({0, 1 + k, 1 + (k + 1) % kSides});
  }
  add_mesh(scene, name, vertices, triangles, share(Material::metal()));
}

TEST(Visibility, ScreenHidesWhatItCoversOfAPlate) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "screen", 5, -2, 0.2, -2, 2);  // up to y = 0.4 of the plate
  const VisibilityFromEnd seen = seen_in(scene, {"plate"}).front().transmitter;
  const double whole = rectangle_angle(-1, 1, -1, 1, 10);
  const double visible = rectangle_angle(0.4, 1, -1, 1, 10) / whole;
  EXPECT_NEAR(seen.solid_angle, whole, kAngleError * whole);
  EXPECT_NEAR(seen.visible_share, visible, kShareError);
  ASSERT_EQ(seen.occluders.size(), 1u);
  EXPECT_NEAR(occluded_by(seen, "screen"), 1.0 - visible, kShareError);
  EXPECT_NEAR(seen.distance, 10.0, kRounding);
}

TEST(Visibility, DiscHidesTheMiddleOfADisc) {
  Scene scene;
  add_disc(scene, "far", 10, 1);
  add_disc(scene, "near", 5, 0.3);
  const auto angle = [](double x, double radius) { return 2 * std::numbers::pi * (1 - x / std::hypot(x, radius)); };
  const std::vector<ObjectVisibility> seen = seen_in(scene, {"far", "near"});
  const double hidden = angle(5, 0.3) / angle(10, 1);
  EXPECT_NEAR(seen[0].transmitter.visible_share, 1 - hidden, kShareError);
  EXPECT_NEAR(occluded_by(seen[0].transmitter, "near"), hidden, kShareError);
  EXPECT_EQ(seen[1].transmitter.visible_share, 1.0);
  EXPECT_TRUE(seen[1].transmitter.occluders.empty());
}

TEST(Visibility, SphereHidesOnlyItself) {
  Scene scene;
  const Surface ball = ellipsoid({8, 1, 0.5}, {1, 1, 1}, 4);
  add_mesh(scene, "ball", ball.vertices, ball.triangles, share(Material::metal()));
  const VisibilityFromEnd seen = seen_in(scene, {"ball"}).front().transmitter;
  const double distance = std::hypot(8.0, 1.0, 0.5);
  const double angle = 2 * std::numbers::pi * (1 - std::sqrt(1 - 1 / (distance * distance)));
  EXPECT_EQ(seen.visible_share, 1.0);
  EXPECT_NEAR(seen.solid_angle, angle, 2 * kAngleError * angle);  // facets of 1/20 rad lie up to 1e-3 inside
  EXPECT_NEAR(seen.distance, distance - 1, 2e-3);
}

TEST(Visibility, PartsOfAnObjectDoNotHideEachOther) {
  Scene scene;
  add_facing(scene, "front", 5, -1, 1, -1, 1);
  add_facing(scene, "back", 6, -1, 1, -1, 1);
  const SurfaceMap both = map_surfaces(scene, {{"both", {"front", "back"}}});
  EXPECT_EQ(visibility(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), both).front().transmitter.visible_share, 1.0);
  EXPECT_EQ(seen_in(scene, {"back"}).front().transmitter.visible_share, 0.0);
}

TEST(Visibility, NearestOccluderHasTheDirection) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "left", 5, 0, 2, -2, 2);
  add_facing(scene, "all", 7, -2, 2, -2, 2);
  const VisibilityFromEnd seen = seen_in(scene, {"plate", "left"}).front().transmitter;
  EXPECT_EQ(seen.visible_share, 0.0);
  EXPECT_NEAR(occluded_by(seen, "left"), 0.5, kShareError);
  EXPECT_NEAR(occluded_by(seen, "all"), 0.5, kShareError);
  double sum = 0.0;
  for (const auto& [name, share] : seen.occluders) sum += share;
  EXPECT_NEAR(sum, 1.0, kSum);
  EXPECT_GE(seen.occluders[0].second, seen.occluders[1].second);
}

TEST(Visibility, EachEndSeesForItself) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "screen", 5, -1, 1, -1, 1);
  const ObjectVisibility seen = seen_in(scene, {"plate"}, plain_radar(Vec3::Zero(), {0, 8, 0})).front();
  EXPECT_EQ(seen.transmitter.visible_share, 0.0);
  EXPECT_EQ(seen.receiver.visible_share, 1.0);
  EXPECT_NEAR(seen.receiver.distance, std::hypot(10.0, 7.0), kRounding);  // the middle of an edge
}

// The receiver is 0.05 m beside the transmitter, near enough to see the same outline. The edge of the screen's shadow on the
// plate lies at y = 0.4 m for the one and at 0.35 m for the other.
TEST(Visibility, EndsNearEachOtherSeeAroundAScreenForThemselves) {
  constexpr double kApart = 0.05;
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "screen", 5, -2, 0.2, -2, 2);
  const ObjectVisibility seen = seen_in(scene, {"plate"}, plain_radar(Vec3::Zero(), {0, kApart, 0})).front();
  const double from_transmitter = rectangle_angle(-1, 1, -1, 1, 10);
  const double from_receiver = rectangle_angle(-1 - kApart, 1 - kApart, -1, 1, 10);
  EXPECT_NEAR(seen.transmitter.visible_share, rectangle_angle(0.4, 1, -1, 1, 10) / from_transmitter, kShareError);
  EXPECT_NEAR(seen.receiver.visible_share, rectangle_angle(0.35 - kApart, 1 - kApart, -1, 1, 10) / from_receiver,
              kShareError);
  EXPECT_NEAR(occluded_by(seen.receiver, "screen"), 1.0 - seen.receiver.visible_share, kSum);
  EXPECT_NEAR(seen.receiver.solid_angle, from_receiver, kAngleError * from_receiver);
}

// A part before the plate belongs to the object with it; the receiver's way to what the transmitter meets leads
// through it.
TEST(Visibility, ObjectsDoNotHideThemselvesFromTheOtherEnd) {
  Scene scene;
  add_facing(scene, "back", 10, -1, 1, -1, 1);
  add_facing(scene, "front", 6, 0.05, 0.5, -1, 1);
  const SurfaceMap both = map_surfaces(scene, {{"both", {"front", "back"}}});
  const ObjectVisibility seen = visibility(scene, plain_radar(Vec3::Zero(), {0, 0.05, 0}), both).front();
  EXPECT_EQ(seen.transmitter.visible_share, 1.0);
  EXPECT_EQ(seen.receiver.visible_share, 1.0);
}

TEST(Visibility, AntennasLookForwardOnly) {
  Scene scene;
  add_facing(scene, "ahead", 10, -1, 1, -1, 1);
  add_facing(scene, "behind", -10, -1, 1, -1, 1);
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.transmitters.front().pattern = AntennaPattern::cosine_power(4);
  const std::vector<ObjectVisibility> seen = seen_in(scene, {"ahead", "behind"}, radar);
  EXPECT_TRUE(seen[0].transmitter.in_view);
  EXPECT_TRUE(seen[0].receiver.in_view);
  EXPECT_FALSE(seen[1].transmitter.in_view);
  EXPECT_TRUE(seen[1].receiver.in_view);
  EXPECT_EQ(seen[1].transmitter.visible_share, 1.0);
  radar.transmitters.front().orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()));
  EXPECT_TRUE(seen_in(scene, {"behind"}, radar).front().transmitter.in_view);
}

TEST(Visibility, LatticeIsRefinedForThinObjects) {
  Scene scene;
  add_facing(scene, "pole", 20, -0.05, 0.05, -3, 3);
  add_facing(scene, "screen", 10, -1, 1, -2, -0.4);  // up to z = -0.8 of the pole
  const VisibilityFromEnd seen = seen_in(scene, {"pole"}).front().transmitter;
  const double whole = rectangle_angle(-0.05, 0.05, -3, 3, 20);
  const double visible = rectangle_angle(-0.05, 0.05, -0.8, 3, 20) / whole;
  EXPECT_NEAR(seen.visible_share, visible, kThinShareError);
  EXPECT_NEAR(seen.solid_angle, whole, 0.01 * whole);
}

TEST(Visibility, EdgeOnNothingIsSeen) {
  Scene scene;
  add_rectangle(scene, "plate", {5, -1, 0}, {1, 0, 0}, {0, 2, 0}, share(Material::metal()));
  const VisibilityFromEnd seen = seen_in(scene, {"plate"}).front().transmitter;
  EXPECT_EQ(seen.solid_angle, 0.0);
  EXPECT_EQ(seen.visible_share, 0.0);
  EXPECT_TRUE(seen.occluders.empty());
  EXPECT_NEAR(seen.distance, 5.0, kRounding);
}

TEST(Visibility, EdgeOnObjectsAreInViewWhereAntennasLook) {
  Scene scene;
  add_rectangle(scene, "ahead", {5, -1, 0}, {1, 0, 0}, {0, 2, 0}, share(Material::metal()));
  add_rectangle(scene, "behind", {-5, -1, 0}, {-1, 0, 0}, {0, 2, 0}, share(Material::metal()));
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.transmitters.front().pattern = AntennaPattern::cosine_power(4);
  const std::vector<ObjectVisibility> seen = seen_in(scene, {"ahead", "behind"}, radar);
  EXPECT_EQ(seen[0].transmitter.solid_angle, 0.0);
  EXPECT_TRUE(seen[0].transmitter.in_view);
  EXPECT_TRUE(seen[0].receiver.in_view);
  EXPECT_FALSE(seen[1].transmitter.in_view);
}

TEST(Visibility, FarFromTheWorldOriginNothingChanges) {
  const Vec3 far(4.5e5, 5.4e6, 100);
  Scene scene;
  add_rectangle(scene, "plate", far + Vec3(10, -1, -1), {0, 2, 0}, {0, 0, 2}, share(Material::metal()));
  add_rectangle(scene, "screen", far + Vec3(5, -2, -2), {0, 2, 0}, {0, 0, 4}, share(Material::metal()));
  EXPECT_NEAR(seen_in(scene, {"plate"}, plain_radar(far, far)).front().transmitter.visible_share, 0.5, kShareError);
}

TEST(Visibility, NumberOfThreadsDoesNotMatter) {
  Scene scene;
  add_disc(scene, "far", 10, 1);
  add_facing(scene, "screen", 5, -2, 0.13, -2, 2);
  test::same_on_any_threads([&] {
    const VisibilityFromEnd seen = seen_in(scene, {"far"}).front().transmitter;
    return std::tuple(seen.visible_share, seen.occluders, seen.distance);
  });
}

TEST(Visibility, LabelsInThePlaneOfAPlateDoNotHideIt) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "label", 10, -0.5, 0.5, -0.5, 0.5);
  const std::vector<ObjectVisibility> seen = seen_in(scene, {"plate", "label"});
  EXPECT_EQ(seen[0].transmitter.visible_share, 1.0);
  EXPECT_EQ(seen[1].transmitter.visible_share, 1.0);
}

// Queries tell 32 children of the root apart; the screen is the 33rd.
TEST(Visibility, AnyNumberOfObjectsHideEachOther) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  for (int k = 1; k < 32; ++k) add_facing(scene, "behind " + std::to_string(k), 11 + 0.1 * k, -1, 1, -1, 1);
  add_facing(scene, "screen", 5, -2, 0, -2, 2);
  const VisibilityFromEnd seen = seen_in(scene, {"plate"}).front().transmitter;
  EXPECT_NEAR(seen.visible_share, 0.5, kShareError);
  EXPECT_NEAR(occluded_by(seen, "screen"), 0.5, kShareError);
}

// Ends that are 5 cm apart see one outline, of which the nearer one sees 1 % more.
TEST(Visibility, SolidAnglesOfNearEndsGoByTheirDistances) {
  constexpr double kFlat = 1e-4;  // relative: a plate of 0.2 m at 10 m is nearly its area over the distance squared
  Scene scene;
  add_facing(scene, "plate", 10, -0.1, 0.1, -0.1, 0.1);
  const ObjectVisibility seen = seen_in(scene, {"plate"}, plain_radar(Vec3::Zero(), {0.05, 0, 0})).front();
  const double expected = rectangle_angle(-0.1, 0.1, -0.1, 0.1, 9.95) / rectangle_angle(-0.1, 0.1, -0.1, 0.1, 10);
  EXPECT_NEAR(seen.receiver.solid_angle / seen.transmitter.solid_angle, expected, kFlat);
}

TEST(Visibility, OccludersComeFromTheLargestToTheSmallest) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "small", 5, 0.35, 2, -2, 2);
  add_facing(scene, "large", 5, -2, 0.1, -2, 2);
  add_facing(scene, "middle", 5, 0.1, 0.35, -2, 2);
  const VisibilityFromEnd seen = seen_in(scene, {"plate"}).front().transmitter;
  std::vector<std::string> names;
  for (const auto& [name, share] : seen.occluders) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"large", "middle", "small"}));
}

TEST(Visibility, KeptGeometryGivesTheSame) {
  Scene scene;
  add_disc(scene, "far", 10, 1);
  add_facing(scene, "screen", 5, -2, 0.13, -2, 2);
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  const SurfaceMap surfaces = map_surfaces(scene, {{"far", {"far"}}});
  const VisibilityFromEnd fresh = visibility(scene, radar, surfaces).front().transmitter;
  KeptGeometry kept;
  for (int turn = 0; turn < 2; ++turn) {
    const VisibilityFromEnd again = visibility(scene, radar, surfaces, {}, nullptr, &kept).front().transmitter;
    EXPECT_EQ(again.visible_share, fresh.visible_share);
    EXPECT_EQ(again.solid_angle, fresh.solid_angle);
    EXPECT_EQ(again.distance, fresh.distance);
  }
}

// A plate at 10 m behind two screens at 5 m, where its shadow reaches from y = -0.5 to 0.5 m. One hides half of it for good;
// the edge of the other is at y = 10 t - 0.6 m.
TEST(Visibility, WhatAMovingScreenUncoversMayAppear) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "screen", 5, 0, 6, -2, 2);
  Node screen = scene.nodes().back();
  screen.name = "moving";
  screen.placement = Transform(Eigen::Translation3d(0.0, -0.6, 0.0));
  screen.motion = std::make_shared<LinearMotion>(Vec3(0.0, 10.0, 0.0));
  scene.add(std::move(screen));
  add_facing(scene, "beside", 10, 5, 6, -1, 1);
  const SurfaceMap surfaces = map_surfaces(scene, {{"plate", {"plate"}}, {"beside", {"beside"}}});
  const auto is_found = [&](double other, const Radar& radar = plain_radar(Vec3::Zero(), Vec3::Zero())) {
    const std::vector<uint32_t> asked{0};
    return !may_appear(scene, radar, surfaces, asked, {0.0, {0.0, other}, 0.05}).empty();
  };
  EXPECT_FALSE(is_found(0.01));   // edge at -0.5 m
  EXPECT_FALSE(is_found(0.013));  // 3 % in sight
  EXPECT_TRUE(is_found(0.018));   // 8 %
  // From 2 m aside the screen that rests hides all of it.
  EXPECT_FALSE(is_found(0.018, plain_radar(Vec3::Zero(), {0, 2, 0})));
  EXPECT_FALSE(is_found(0.018, plain_radar({0, 2, 0}, Vec3::Zero())));
}

// Two screens that touch each other, of which one comes where the other goes.
TEST(Visibility, WhatOneScreenUncoversForAnotherStaysHidden) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  for (const auto& [name, begin, end] : {std::tuple("goes", -6.0, 0.1), std::tuple("comes", 0.0, 6.0)}) {
    add_facing(scene, name, 5, begin, end, -2, 2);
    Node screen = scene.nodes().back();
    screen.motion = std::make_shared<LinearMotion>(Vec3(0.0, -10.0, 0.0));
    scene.change(static_cast<int>(scene.nodes().size()) - 1, std::move(screen));
  }
  const SurfaceMap surfaces = map_surfaces(scene, {{"plate", {"plate"}}});
  const std::vector<uint32_t> asked{0};
  const AppearingSettings settings{0.0, {0.0, 0.02, 0.06}, 0.05};
  EXPECT_TRUE(may_appear(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), surfaces, asked, settings).empty());
}

// The one direction goes between two plates, so that nothing is known of them.
TEST(Visibility, WhatNoDirectionMeetsMayAppear) {
  Scene scene;
  add_facing(scene, "object_left", 10, -1, -0.8, -1, 1);
  add_facing(scene, "object_right", 10, 0.8, 1, -1, 1);
  add_facing(scene, "screen", 5, -6, 6, -2, 2);
  const SurfaceMap surfaces = map_surfaces(scene, {{"object", {"object*"}}});
  const std::vector<uint32_t> asked{0};
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  EXPECT_EQ(may_appear(scene, radar, surfaces, asked, {0.0, {0.01}, 0.05, 1}), asked);
  EXPECT_TRUE(may_appear(scene, radar, surfaces, asked, {0.0, {0.01}, 0.05}).empty());
}

// What a screen or an object that bends will be like is not followed.
TEST(Visibility, WhatBendsOrWhatSuchHidesMayAppear) {
  for (const std::string bends : {"none", "plate", "screen"}) {
    Scene scene;
    for (const auto& [name, distance, half] : {std::tuple("plate", 10.0, 1.0), std::tuple("screen", 5.0, 2.0)}) {
      add_facing(scene, name, distance, -half, half, -half, half);
      if (name != bends) continue;
      Node node = scene.nodes().back();
      const std::vector<Vec3>& corners = node.mesh->vertices();
      node.deformation = std::make_shared<VertexSequence>(std::vector<double>{0.0, 1.0}, std::vector{corners, corners});
      scene.change(static_cast<int>(scene.nodes().size()) - 1, std::move(node));
    }
    const SurfaceMap surfaces = map_surfaces(scene, {{"plate", {"plate"}}});
    const std::vector<uint32_t> asked{0};
    const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
    EXPECT_EQ(may_appear(scene, radar, surfaces, asked, {0.0, {0.01}, 0.05}).empty(), bends == "none") << bends;
  }
}

// A radar that drives to the right looks past the edge of a screen at 5 m: from y = -10 t, the screen at y > -0.6 m leaves
// the plate free at y < 10 t - 1.2 m.
TEST(Visibility, WhatTheRadarDrivesPastMayAppear) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "screen", 5, -0.6, 6, -2, 2);
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.motion = std::make_shared<LinearMotion>(Vec3(0.0, -10.0, 0.0));
  const SurfaceMap surfaces = map_surfaces(scene, {{"plate", {"plate"}}});
  const auto is_found = [&](double time, double other) {
    const std::vector<uint32_t> asked{0};
    return !may_appear(scene, radar, surfaces, asked, {time, {time, other}, 0.05}).empty();
  };
  for (const double time : {0.0, 0.01}) {
    EXPECT_FALSE(is_found(time, 0.026)) << "3 % in sight";
    EXPECT_TRUE(is_found(time, 0.036)) << "8 %";
  }
}

TEST(Visibility, CancelledJobStops) {
  Scene scene;
  add_disc(scene, "far", 10, 1);
  Job job;
  job.cancel();
  EXPECT_THROW(visibility(scene, plain_radar(Vec3::Zero(), Vec3::Zero()), map_surfaces(scene, {{"far", {"far"}}}), {}, &job),
               Cancelled);
}

TEST(Visibility, EmptySceneHasNoObjects) {
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  EXPECT_TRUE(visibility(Scene(), radar, map_surfaces(Scene(), 0.0, Vec3::Zero())).empty());
}

TEST(Visibility, BadSettingsAreErrors) {
  Scene scene;
  add_disc(scene, "far", 10, 1);
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  EXPECT_THROW(visibility(scene, radar, map_surfaces(scene, 0.0, Vec3::Zero()), {0.0, 0}), std::invalid_argument);
  EXPECT_THROW(visibility(scene, radar, map_surfaces(Scene(), 0.0, Vec3::Zero())), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_visibility
