// What planes send back aslant at most: against the integral of physical optics over them, point by point.
#include <gtest/gtest.h>

#include <complex>
#include <random>

#include "cpp/support/scenes.h"
#include "echopath/base/constants.h"
#include "echopath/power/plane_rims.h"

namespace echopath::test_plane_rims {
namespace {

using namespace testing;

constexpr double kFrequency = 3e9, kWidth = 1.0, kHeight = 0.6;  // Hz, m
constexpr double kOfHigherOrders = 1.05;                         // the rims' waves are the first order in 1/k
constexpr double kLeastShare = 0.05;                             // of the bound: mean square of what is sent back
constexpr int kPoses = 60, kSteps = 400;

Radar radar() {
  Radar radar;
  radar.waveform.start_frequency = kFrequency;
  radar.transmitters = {Antenna{}};
  radar.receivers = {Antenna{}};
  return radar;
}

Node plate(const Transform& place) {
  Node node;
  node.name = "plate";
  node.mesh = std::make_shared<Mesh>(std::vector<Vec3>{{0, 0, 0}, {kWidth, 0, 0}, {kWidth, kHeight, 0}, {0, kHeight, 0}},
                                     std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  node.material = share(Material::metal());
  node.placement = place;
  return node;
}

// The integral of cos(theta) exp(-2jkR) / (lambda R^2), by the middles of small rectangles.
double sent_back(const Transform& place) {
  const double turns = kFrequency / kSpeedOfLight, dx = kWidth / kSteps, dy = kHeight / kSteps;
  const Vec3 normal = place.linear() * Vec3::UnitZ();
  std::complex<double> sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Vec3 point = place * Vec3((i + 0.5) * dx, (j + 0.5) * dy, 0.0);
      const double distance = point.norm();
      sum += std::polar(std::abs(normal.dot(point)) / (distance * distance * distance), -2.0 * kTwoPi * turns * distance);
    }
  }
  return turns * dx * dy * std::abs(sum);
}

// Area of a triangle on the unit sphere by its sides (l'Huilier).
double spherical_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto side = [](const Vec3& from, const Vec3& to) { return std::acos(from.dot(to)); };
  const double x = side(a, b), y = side(b, c), z = side(c, a), s = 0.5 * (x + y + z);
  const auto half = [](double angle) { return std::tan(0.5 * angle); };
  return 4.0 * std::atan(std::sqrt(std::max(0.0, half(s) * half(s - x) * half(s - y) * half(s - z))));
}

struct Case {
  Transform place;
  PlaneWaves waves;
  double exact = 0.0;  // 1/m
};

std::vector<Case> cases() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  std::vector<Case> found;
  while (found.size() < kPoses) {
    Case one;
    one.place = Eigen::Translation3d(6.0 + 2.0 * draw(random), 2.0 * draw(random), draw(random)) *
                Eigen::Quaterniond(draw(random), draw(random), draw(random), draw(random)).normalized();
    Scene scene;
    scene.add(plate(one.place));
    one.waves = PlaneRims(scene, radar(), 0.0).of(0);
    if (std::isinf(one.waves.planes.front().own)) continue;  // it reflects
    one.exact = sent_back(one.place);
    found.push_back(one);
  }
  return found;
}

// Of an even lattice of rays of which each triangle has its share.
double at_most(const PlaneWaves& waves, double share_seen) {
  const double density = 1e6 / waves.planes.front().solid_angle;
  return waves.at_most({static_cast<int64_t>(share_seen * 5e5), static_cast<int64_t>(share_seen * 5e5)}, density);
}

TEST(PlaneRims, HoldWhatPlatesSendBackAslant) {
  double share = 0.0;
  for (const Case& one : cases()) {
    const double most = at_most(one.waves, 1.0);
    EXPECT_LE(one.exact, kOfHigherOrders * most) << one.place.matrix();
    share += one.exact * one.exact / (most * most) / kPoses;
  }
  EXPECT_GE(share, kLeastShare);  // a bound that is far too wide would hold, too
}

TEST(PlaneRims, OfAPlaneOfWhichAPartIsHiddenAreMore) {
  for (const Case& one : cases()) {
    EXPECT_GT(at_most(one.waves, 0.5), at_most(one.waves, 1.0));
    EXPECT_EQ(at_most(one.waves, 0.0), at_most(one.waves, 0.5));  // rays may be left out of a record
  }
}

TEST(PlaneRims, AreNotKnownWhereThePlaneReflectsOrStandsForACurvedSurface) {
  Scene scene;
  const Transform facing(Eigen::Translation3d(-0.5 * kWidth, -0.5 * kHeight, 5.0));
  scene.add(plate(facing));
  Node ball = plate(facing);
  ball.name = "ball";
  const Surface surface = ellipsoid(Vec3(0, 0, 9), Vec3::Constant(0.5), 2);
  ball.mesh = std::make_shared<Mesh>(surface.vertices, surface.triangles);
  ball.smooth = true;
  scene.add(ball);
  PlaneRims rims(scene, radar(), 0.0);
  EXPECT_TRUE(std::isinf(at_most(rims.of(0), 1.0)));
  EXPECT_TRUE(std::isinf(rims.of(1).at_most({}, 1.0)));
}

// The facets of an icosahedron that face the antennas fill its outline, however they are wound.
TEST(PlaneRims, OfAClosedBodyAreThoseOfTheSideThatFacesTheAntennas) {
  Surface ball = ellipsoid(Vec3(7.0, 1.0, 0.5), Vec3::Constant(0.8), 0);
  for (const bool is_turned : {false, true}) {
    double outline = 0.0, facing = 0.0;
    for (Triangle& triangle : ball.triangles) {
      const Vec3 a = ball.vertices[triangle[0]], b = ball.vertices[triangle[1]], c = ball.vertices[triangle[2]];
      outline += 0.5 * spherical_area(a.normalized(), b.normalized(), c.normalized());  // the far side fills it, too
      if (is_turned) std::swap(triangle[1], triangle[2]);
    }
    Scene scene;
    add_mesh(scene, "ball", ball.vertices, ball.triangles, share(Material::metal()));
    const PlaneWaves waves = PlaneRims(scene, radar(), 0.0).of(0);
    for (const RimWaves& plane : waves.planes) facing += plane.solid_angle;
    EXPECT_LT(waves.planes.size(), 15u);
    EXPECT_NEAR(facing / outline, 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace echopath::test_plane_rims
