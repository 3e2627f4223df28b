#include <gtest/gtest.h>

#include "cpp/label/plates.h"

namespace echopath::test_hidden_objects {
namespace {

using namespace testing;

constexpr double kShareError = 2e-3;        // as in test_visibility.cpp
constexpr double kHiddenAngleError = 0.03;  // relative: 512 directions

TEST(Visibility, HiddenObjectsKeepTheirSolidAngle) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_facing(scene, "screen", 5, -1, 1, -1, 1);
  const VisibilityFromEnd seen = seen_in(scene, {"plate"}).front().transmitter;
  const double whole = rectangle_angle(-1, 1, -1, 1, 10);
  EXPECT_EQ(seen.visible_share, 0.0);
  EXPECT_EQ(occluded_by(seen, "screen"), 1.0);
  EXPECT_NEAR(seen.solid_angle, whole, kHiddenAngleError * whole);
  EXPECT_TRUE(seen.in_view);
}

// The plate is seen through a gap between two screens of one name, as wide as a sixth of it.
TEST(Visibility, GapsInWhatHidesAnObjectAreFound) {
  Scene scene;
  add_facing(scene, "plate", 10, -1, 1, -1, 1);
  add_mesh(scene, "screen",
           {{5, -2, -2}, {5, 0.1, -2}, {5, 0.1, 2}, {5, -2, 2}, {5, 4.0 / 15, -2}, {5, 2, -2}, {5, 2, 2}, {5, 4.0 / 15, 2}},
           {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, share(Material::metal()));
  const VisibilityFromEnd seen = seen_in(scene, {"plate"}).front().transmitter;
  const double visible = rectangle_angle(0.2, 8.0 / 15, -1, 1, 10) / rectangle_angle(-1, 1, -1, 1, 10);
  EXPECT_NEAR(seen.visible_share, visible, kShareError);
  EXPECT_NEAR(occluded_by(seen, "screen"), 1.0 - visible, kShareError);
}

// A plate of 2 m behind one screen with a slit from top to bottom, whose shadow on the plate is 3 to 4 % of its width,
// wherever it is.
TEST(Visibility, SlitsInWhatHidesAreSeen) {
  constexpr double kSlit = 0.035, kShareOfSlit = 0.012;  // m at 5 m: half of it on the plate; error of a share
  for (const int num_directions : {128, 512, 1024, 4096}) {
    for (int place = 0; place < 19; ++place) {
      const double left = -0.45 + 0.046 * place, right = left + kSlit;
      Scene scene;
      add_facing(scene, "plate", 10, -1, 1, -1, 1);
      const std::vector<Vec3> corners{{5, -2, -2},    {5, left, -2}, {5, left, 2}, {5, -2, 2},
                                      {5, right, -2}, {5, 2, -2},    {5, 2, 2},    {5, right, 2}};
      add_mesh(scene, "screen", corners, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, share(Material::metal()));
      const SurfaceMap surfaces = map_surfaces(scene, {{"plate", {"plate"}}});
      const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
      const double found = visibility(scene, radar, surfaces, {0.0, num_directions}).front().transmitter.visible_share;
      const double visible = rectangle_angle(2 * left, 2 * right, -1, 1, 10) / rectangle_angle(-1, 1, -1, 1, 10);
      EXPECT_NEAR(found, visible, kShareOfSlit) << num_directions << " at " << left;
    }
  }
}

}  // namespace
}  // namespace echopath::test_hidden_objects
