// What planes that reflect nothing send on at most: against the integral of physical optics over them, point by point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "cpp/support/scenes.h"
#include "echopath/base/constants.h"
#include "echopath/power/interval/plane_rims.h"

namespace echopath::test_plane_rims {
namespace {

using namespace testing;

constexpr double kFrequency = 3e9, kWidth = 1.0, kHeight = 0.6;  // Hz, m
constexpr double kOfHigherOrders = 1.05;                         // the rims' waves are the first order in 1/k
constexpr double kLeastShare = 0.05;                             // of the bound: mean square of what is sent back
constexpr int kPoses = 60, kSteps = 400;

constexpr double kWavenumber = kTwoPi * kFrequency / kSpeedOfLight;

struct Plate {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
};

Plate plate(const Transform& place) {
  Plate plate;
  for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(kWidth, 0, 0), Vec3(kWidth, kHeight, 0), Vec3(0, kHeight, 0)}) {
    plate.vertices.push_back(place * corner);
  }
  return plate;
}

// The integral of cos(theta) exp(-jk(R1 + R2)) / (lambda R1 R2), by the middles of small rectangles.
double sent_on(const Transform& place, const AntennaPair& antennas) {
  const double dx = kWidth / kSteps, dy = kHeight / kSteps;
  const Vec3 normal = place.linear() * Vec3::UnitZ();
  std::complex<double> sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Vec3 point = place * Vec3((i + 0.5) * dx, (j + 0.5) * dy, 0.0), in = point - antennas.from;
      const double length_in = in.norm(), length_out = (point - antennas.to).norm();
      sum += std::polar(std::abs(normal.dot(in)) / (length_in * length_in * length_out),
                        -kWavenumber * (length_in + length_out));
    }
  }
  return kWavenumber / kTwoPi * dx * dy * std::abs(sum);
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
  AntennaPair antennas;
  std::vector<RimWaves> waves;
  double exact = 0.0;  // 1/m
};

// `apart`: m, the most by which the antennas are from the origin along each axis.
std::vector<Case> cases(double apart) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  const auto near_origin = [&]() -> Vec3 { return apart * Vec3(draw(random), draw(random), draw(random)); };
  std::vector<Case> found;
  while (found.size() < kPoses) {
    Case one;
    one.place = Eigen::Translation3d(6.0 + 2.0 * draw(random), 2.0 * draw(random), draw(random)) *
                Eigen::Quaterniond(draw(random), draw(random), draw(random), draw(random)).normalized();
    one.antennas = {near_origin(), near_origin()};
    const Plate plate = test_plane_rims::plate(one.place);
    one.waves = FacetedBody(plate.vertices, plate.triangles, false).waves(one.antennas, kWavenumber);
    if (std::isinf(one.waves.front().own) || one.waves.front().own == 0.0) continue;  // it reflects, or is between both
    one.exact = sent_on(one.place, one.antennas);
    found.push_back(one);
  }
  return found;
}

double at_most(const std::vector<RimWaves>& waves, double share_seen) {
  return rims_at_most(waves, std::vector{share_seen * waves.front().solid_angle});
}

class RimsOfPlates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(AntennasApart, RimsOfPlates, ::testing::Values(0.0, 0.1, 3.0));

TEST_P(RimsOfPlates, HoldWhatTheySendOnAslant) {
  double share = 0.0;
  for (const Case& one : cases(GetParam())) {
    const double most = at_most(one.waves, 1.0);
    EXPECT_LE(one.exact, kOfHigherOrders * most) << one.place.matrix();
    share += one.exact * one.exact / (most * most) / kPoses;
  }
  EXPECT_GE(share, kLeastShare);  // a bound that is far too wide would hold, too
}

TEST_P(RimsOfPlates, AreMoreWhereAPartIsHidden) {
  for (const Case& one : cases(GetParam())) {
    EXPECT_GT(at_most(one.waves, 0.5), at_most(one.waves, 1.0));
    EXPECT_EQ(at_most(one.waves, 0.0), at_most(one.waves, 0.5));  // rays may be left out of a record
    EXPECT_EQ(rims_at_most(one.waves, {}), at_most(one.waves, 0.5));
  }
}

TEST(PlaneRims, AreNotKnownWhereThePlaneReflects) {
  const Plate plate = test_plane_rims::plate(Transform(Eigen::Translation3d(-0.5 * kWidth, -0.5 * kHeight, 5.0)));
  const FacetedBody body(plate.vertices, plate.triangles, false);
  // The image of the receiver lies behind the plate: the way to it meets that at 5/7 of its length.
  const AntennaPair within{Vec3::Zero(), Vec3(0.6 * kWidth, 0.0, 3.0)}, beside{Vec3::Zero(), Vec3(1.5 * kWidth, 0.0, 3.0)};
  EXPECT_TRUE(std::isinf(rims_at_most(body.waves({}, kWavenumber), {})));
  EXPECT_TRUE(std::isinf(rims_at_most(body.waves(within, kWavenumber), {})));
  EXPECT_FALSE(std::isinf(rims_at_most(body.waves(beside, kWavenumber), {})));
}

TEST(PlaneRims, AreThoseOfThePlaneWhereItsFirstTriangleIsASliver) {
  Plate plate = test_plane_rims::plate(Transform(Eigen::Translation3d(1.0, 0.5, 5.0)));
  const double whole = rims_at_most(FacetedBody(plate.vertices, plate.triangles, false).waves({}, kWavenumber), {});
  plate.triangles.insert(plate.triangles.begin(), {0, 1, 1});
  const double found = rims_at_most(FacetedBody(plate.vertices, plate.triangles, false).waves({}, kWavenumber), {});
  EXPECT_GE(found, whole);
}

TEST(PlaneRims, OfAPlaneBetweenTheAntennasAreNone) {
  const Plate plate = test_plane_rims::plate(Transform(Eigen::Translation3d(1.0, 0.0, 5.0)));
  const FacetedBody body(plate.vertices, plate.triangles, false);
  EXPECT_EQ(rims_at_most(body.waves({Vec3::Zero(), Vec3(0, 0, 9)}, kWavenumber), {}), 0.0);
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
    const auto waves = FacetedBody(ball.vertices, ball.triangles, true).waves({}, kWavenumber);
    for (const RimWaves& plane : waves) facing += plane.solid_angle;
    EXPECT_GT(std::ranges::count(waves, 0.0, &RimWaves::own), 5);
    EXPECT_NEAR(facing / outline, 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace echopath::test_plane_rims
