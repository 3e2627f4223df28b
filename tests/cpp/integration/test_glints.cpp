// Points of reflection that a record shows, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/scenes.h"
#include "echopath/base/constants.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/sim/rays/ray_allocation.h"

namespace echopath::test_glints {
namespace {

using namespace testing;

constexpr double kDirection = 2e-4;           // rad: a fifth of a Fresnel zone of the ball
constexpr double kZone = 0.05;                // relative, of interpolated curvatures
constexpr double kPowerDb = 0.5;              // of stationary phase with the amplitude of a path beside the point
constexpr double kShares = 1e-9;              // relative: sums of some ten shares
constexpr double kRoundedShare = 1.0 / 64.0;  // relative: rounded_rays

Radar radar() { return plain_radar(Vec3::Zero(), Vec3::Zero()); }
double wavelength() { return kSpeedOfLight / radar().waveform.start_frequency; }

void add_ball(Scene& scene, const std::string& name, const Vec3& centre, double radius) {
  add_smooth_ball(scene, name, centre, radius, 4);
}

Paths shot(const Scene& scene, int batches = 1, int max_bounces = 1) {
  TraceSettings settings = with_rays(20000, max_bounces);
  settings.batches = batches;
  return trace(scene, radar(), settings);
}

TEST(Glints, OfABallAreWhereWhatAndAsStrongAsGeometricalOpticsSays) {
  Scene scene;
  const Vec3 centre(8, 1, 0.5);
  const double radius = 0.2, range = centre.norm() - radius;
  add_ball(scene, "ball", centre, radius);
  const double field = wavelength() / (4.0 * kPi * range) * radius / (2.0 * (radius + range));
  const double zone = std::sqrt(0.5 * wavelength() / (1.0 / range + 1.0 / radius)) / range;  // half a cycle there and back
  for (const int batches : {1, 8}) {
    const std::vector<Glint> glints = find_glints(shot(scene, batches));
    ASSERT_EQ(glints.size(), 1u) << batches;
    EXPECT_LT((glints[0].direction - centre.normalized()).norm(), kDirection);
    EXPECT_NEAR(glints[0].narrow / zone, 1.0, kZone);
    EXPECT_NEAR(glints[0].wide / zone, 1.0, kZone);
    EXPECT_NEAR(10.0 * std::log10(glints[0].power / (field * field)), 0.0, kPowerDb) << batches;
  }
}

// A plane that is larger than its Fresnel zone, of 4 cm here, is imaged, and needs no rays.
TEST(Glints, OfASmallPlaneLieAtItsFoot) {
  Scene scene;
  add_rectangle(scene, "step", {-0.02, -0.02, -2}, {0.04, 0, 0}, {0, 0.04, 0}, share(Material::metal()));
  const std::vector<Glint> glints = find_glints(shot(scene));
  ASSERT_EQ(glints.size(), 1u);
  EXPECT_LT((glints[0].direction + Vec3::UnitZ()).norm(), kDirection);
}

TEST(Glints, ThatAreHiddenAreNone) {
  Scene scene;
  add_ball(scene, "ball", {8, 0, 0}, 0.2);
  add_rectangle(scene, "screen", {4, -0.05, -0.05}, {0, 0.1, 0}, {0, 0, 0.1}, lambert(0.5));
  EXPECT_TRUE(find_glints(shot(scene)).empty());
}

// One over the wall one way, one both ways, and the ball's own.
TEST(Glints, OverAMirrorLieTowardTheImage) {
  Scene scene;
  add_ball(scene, "ball", {8, 0, 0}, 0.2);
  add_rectangle(scene, "wall", {0, 3, -5}, {20, 0, 0}, {0, 0, 10}, share(Material::metal(true)));
  const Paths paths = shot(scene, 1, 3);
  bool is_seen_both_ways = false;
  for (const Glint& glint : find_glints(paths)) {
    is_seen_both_ways = is_seen_both_ways || (glint.direction - Vec3(8, 6, 0).normalized()).norm() < kDirection;
  }
  EXPECT_TRUE(is_seen_both_ways);
}

TEST(Glints, OfNothingAreNone) { EXPECT_TRUE(find_glints(shot(Scene())).empty()); }

TEST(GuideRays, AddUpAndDoNotDependOnTheNumberOfThreads) {
  Scene scene;
  add_ball(scene, "near", {8, 0, 0}, 0.2);
  add_ball(scene, "far", {30, 4, 0}, 0.5);
  const Paths pilot = shot(scene);
  std::vector<LaunchGuide> guides;
  for (const int threads : {1, 2}) {
    set_num_threads(threads);
    guides.push_back(guide_rays(pilot, ray_needs(pilot, WantedError{}), 100000));
  }
  set_num_threads(0);
  double rays = 0.0;
  for (const auto& [name, share] : guides[0].shares) rays += share;
  for (const LaunchFocus& focus : guides[0].foci) rays += focus.share;
  EXPECT_NEAR(rays / 100000.0, 1.0, kRoundedShare);
  for (const LaunchFocus& focus : guides[0].foci) EXPECT_EQ(focus.share, rounded_rays(focus.share));
  for (const auto& [name, share] : guides[0].shares) {
    double with_foci = share;
    for (const LaunchFocus& focus : guides[0].foci) with_foci += focus.of == name ? focus.share : 0.0;
    EXPECT_NEAR(rounded_rays(with_foci), with_foci, kShares * with_foci) << name;
  }
  ASSERT_GE(guides[0].foci.size(), 1u);
  EXPECT_EQ(guides[0].shares, guides[1].shares);
  ASSERT_EQ(guides[0].foci.size(), guides[1].foci.size());
  for (size_t i = 0; i < guides[0].foci.size(); ++i) {
    EXPECT_EQ(guides[0].foci[i].axis, guides[1].foci[i].axis);
    EXPECT_EQ(guides[0].foci[i].share, guides[1].foci[i].share);
  }
}

}  // namespace
}  // namespace echopath::test_glints
