// Ends of surfaces against where they were put, and fields beside edges against Fresnel's integrals.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "cpp/support/scenes.h"
#include "echopath/base/constants.h"
#include "echopath/trace/mirrors/mirror_zone.h"

namespace echopath::test_mirror_zone {
namespace {

constexpr double kGap = 2e-4;          // m
constexpr double kRounding = 1e-6;     // m: hits are known in single precision
constexpr double kRational = 2e-3;     // of the auxiliary functions
constexpr double kWavelength = 0.004;  // m
constexpr double kReach = 10.0;        // m

// Metal rectangles, looked at from above.
class Plates {
 public:
  void add(const std::string& name, const Vec3& corner, const Vec3& a, const Vec3& b) {
    testing::add_rectangle(scene_, name, corner, a, b, testing::share(Material::metal()));
  }
  void look_at(double x, double y) {
    geometry_ = std::make_unique<EmbreeScene>(scene_, PosedScene(scene_, 0.0), Vec3::Zero());
    ASSERT_EQ(geometry_->intersect(Vec3(x, y, 5), -Vec3::UnitZ(), hit_), EmbreeScene::Verdict::kHit);
  }
  SurfaceEnd end(const Vec3& along) { return around().find_end(along, kReach); }
  SurfaceEnd end_of_plane(const Vec3& along) { return around(Extent::kPlane).find_end(along, kReach); }
  bool reaches(const Vec3& along, double distance) { return around().reaches(along, distance); }
  bool holds_circle(double radius) { return around().holds_circle(radius * radius); }
  ZoneCover cover(double before, double behind, const Vec3& arrival = -Vec3::UnitZ()) {
    const MirrorView view{hit_, arrival, before, behind};
    return cover_of_zone(*geometry_, view, nullptr, kWavelength, num_queries_);
  }
  int64_t num_queries() const { return num_queries_; }

 private:
  SurfaceAround around(Extent extent = Extent::kBent) { return SurfaceAround(*geometry_, hit_, kGap, num_queries_, extent); }

  Scene scene_;
  std::unique_ptr<EmbreeScene> geometry_;
  RayHit hit_;
  int64_t num_queries_ = 0;
};

TEST(MirrorZone, APlateEndsAtItsEdges) {
  Plates plates;
  plates.add("plate", Vec3(-1, -2, 0), Vec3(2, 0, 0), Vec3(0, 4, 0));
  plates.look_at(0.3, 0.7);
  EXPECT_NEAR(plates.end(Vec3::UnitX()).distance, 0.7, kRounding);
  EXPECT_NEAR(plates.end(-Vec3::UnitX()).distance, 1.3, kRounding);
  EXPECT_NEAR(plates.end(-Vec3::UnitY()).distance, 2.7, kRounding);
  EXPECT_FALSE(plates.end(Vec3::UnitX()).is_wall);
  EXPECT_TRUE(plates.reaches(Vec3::UnitX(), 0.69));
  EXPECT_FALSE(plates.reaches(Vec3::UnitX(), 0.71));
}

TEST(MirrorZone, PlatesThatAbutAreOneSurface) {
  Plates plates;
  const double places[] = {-1, -0.4, 0.5, 0.502, 2};  // one is a strip
  for (int k = 0; k < 4; ++k) {
    // Rims in common, but no corners; the last leaves a slit.
    const double slit = k == 3 ? 0.5 * kGap : 0.0, low = -2 - 0.1 * k;
    plates.add("part" + std::to_string(k), Vec3(places[k] + slit, low, 0), Vec3(places[k + 1] - places[k] - slit, 0, 0),
               Vec3(0, 4, 0));
  }
  plates.look_at(0.3, 0.7);
  EXPECT_NEAR(plates.end(Vec3::UnitX()).distance, 1.7, kRounding);
  EXPECT_NEAR(plates.end(-Vec3::UnitX()).distance, 1.3, kRounding);
  EXPECT_TRUE(plates.reaches(Vec3::UnitX(), 1.69));
}

// The flanks of two cars in a row, each in two halves: where the point's own triangle ends makes no difference.
TEST(MirrorZone, ASurfaceEndsBeforeAGapHoweverItIsCut) {
  for (const double x : {-0.9, -0.7, -0.5, -0.3, 0.1, 0.5, 0.9}) {
    for (const double y : {-0.45, 0.05, 0.35}) {
      Plates plates;
      plates.add("first half", Vec3(-1, -0.5, 0), Vec3(0.8, 0, 0), Vec3(0, 1, 0));
      plates.add("second half", Vec3(-0.2, -0.5, 0), Vec3(1.2, 0, 0), Vec3(0, 1, 0));
      plates.add("next", Vec3(4, -0.5, 0), Vec3(20, 0, 0), Vec3(0, 1, 0));
      plates.look_at(x, y);
      EXPECT_NEAR(plates.end(Vec3::UnitX()).distance, 1 - x, kRounding) << x << ' ' << y;
      EXPECT_NEAR(plates.end_of_plane(Vec3::UnitX()).distance, 1 - x, kRounding) << x << ' ' << y;
      // At a grazing incidence of .02 rad the zone is 2 sqrt(.004 m 5 m)/.02 long, and narrower than the plates.
      EXPECT_NEAR(plates.cover(10, 10, Vec3(1, 0, -0.02).normalized()).share, 0.02 / std::sqrt(0.02), 1e-3) << x << ' ' << y;
    }
  }
}

TEST(MirrorZone, AStepEndsASurface) {
  Plates plates;
  plates.add("plate", Vec3(-1, -2, 0), Vec3(2, 0, 0), Vec3(0, 4, 0));
  plates.add("below", Vec3(1, -2, -0.01), Vec3(5, 0, 0), Vec3(0, 4, 0));
  plates.look_at(0, 0);
  EXPECT_NEAR(plates.end(Vec3::UnitX()).distance, 1.0, kRounding);
  EXPECT_FALSE(plates.reaches(Vec3::UnitX(), 1.5));
}

TEST(MirrorZone, TheInsideOfACornerIsNoEdgeAndTheOutsideIsOne) {
  Plates plates;
  plates.add("floor", Vec3(-1, -2, 0), Vec3(2, 0, 0), Vec3(0, 4, 0));
  plates.add("wall", Vec3(1, -2, 0), Vec3(0, 4, 0), Vec3(0, 0, 3));
  plates.add("side", Vec3(-1, -2, -3), Vec3(0, 4, 0), Vec3(0, 0, 3));
  plates.look_at(0.3, 0);
  EXPECT_TRUE(plates.end(Vec3::UnitX()).is_wall);
  EXPECT_NEAR(plates.end(Vec3::UnitX()).distance, 0.7, kRounding);
  EXPECT_FALSE(plates.end(-Vec3::UnitX()).is_wall);
  EXPECT_NEAR(plates.end(-Vec3::UnitX()).distance, 1.3, kRounding);
}

TEST(MirrorZone, AGentleBendGoesOn) {
  Plates plates;
  plates.add("flat", Vec3(-1, -2, 0), Vec3(2, 0, 0), Vec3(0, 4, 0));
  plates.add("bent", Vec3(1, -2, 0), Vec3(2, 0, -0.2), Vec3(0, 4, 0));
  plates.look_at(0.3, 0);
  EXPECT_TRUE(plates.reaches(Vec3::UnitX(), 2.0));
}

TEST(MirrorZone, APlaneEndsAtAGentleBendDownOrUp) {
  Plates plates;
  plates.add("flat", Vec3(-1, -2, 0), Vec3(2, 0, 0), Vec3(0, 4, 0));
  plates.add("seamless", Vec3(1, -2, 0), Vec3(1, 0, 0.5 * kGap), Vec3(0, 4, 0));
  plates.add("down", Vec3(2, -2, 0), Vec3(2, 0, -0.01), Vec3(0, 4, 0));
  plates.add("up", Vec3(-1, -2, 0), Vec3(0, 4, 0), Vec3(-2, 0, 0.01));
  plates.look_at(0.3, 0);
  EXPECT_NEAR(plates.end_of_plane(Vec3::UnitX()).distance, 1.7, kRounding);
  EXPECT_NEAR(plates.end_of_plane(-Vec3::UnitX()).distance, 1.3, kRounding);
  EXPECT_FALSE(plates.end_of_plane(Vec3::UnitX()).is_wall);
  EXPECT_FALSE(plates.end_of_plane(-Vec3::UnitX()).is_wall);
}

// Straight down at the middle of a square: both half zones are sqrt(wavelength / (1/before + 1/behind)).
TEST(MirrorZone, CoverIsTheShareOfTheZone) {
  const double before = 4.0, behind = 1.0, half = std::sqrt(kWavelength / (1 / before + 1 / behind));
  for (const double part : {0.3, 0.8, 1.0, 1.3, 3.0}) {
    Plates plates;
    const double side = 2.0 * part * half;
    plates.add("plate", Vec3(-0.5 * side, -0.5 * side, 0), Vec3(side, 0, 0), Vec3(0, side, 0));
    plates.look_at(1e-4, 2e-4);
    const double share = std::min(1.0, part);
    EXPECT_NEAR(plates.cover(before, behind).share, share * share, 1e-5) << part;
    EXPECT_NEAR(plates.cover(behind, before).share, share * share, 1e-5) << part;
  }
}

// The two triangles of a plate lie on either side of one of its diagonals, from which these places are equally far.
TEST(MirrorZone, ATriangleHoldsCirclesUpToItsNearestEdge) {
  Plates plates;
  plates.add("plate", Vec3(-1, -2, 0), Vec3(2, 0, 0), Vec3(0, 4, 0));
  plates.look_at(0.9, 0.0);
  EXPECT_TRUE(plates.holds_circle(0.1 - kRounding));
  EXPECT_FALSE(plates.holds_circle(0.1 + kRounding));
  plates.look_at(0.0, 1.0);
  EXPECT_TRUE(plates.holds_circle(1.0 / std::sqrt(5.0) - kRounding));
  EXPECT_FALSE(plates.holds_circle(1.0 / std::sqrt(5.0) + kRounding));
}

// A wave that comes at a slant lights a zone that is longer in the plane of incidence, by one over the cosine.
TEST(MirrorZone, AStripIsNarrowerThanTheZoneOfASlantingWave) {
  const double before = 4.0, behind = 1.0, across = std::sqrt(kWavelength / (1 / before + 1 / behind)), cosine = 0.25;
  const double width = 3.0 * across, length = 400.0 * across;  // halves
  Plates plates;
  plates.add("strip", Vec3(-width, -length, 0), Vec3(2 * width, 0, 0), Vec3(0, 2 * length, 0));
  plates.look_at(0.0, 0.5 * length);  // a quarter of the strip from its diagonal
  const Vec3 slant(std::sqrt(1 - cosine * cosine), 0, -cosine);
  EXPECT_NEAR(plates.cover(before, behind, slant).share, width / (across / cosine), 1e-5);
  const int64_t num_of_slanting = plates.num_queries();
  EXPECT_GT(num_of_slanting, 0);
  EXPECT_EQ(plates.cover(before, behind).share, 1.0);
  EXPECT_EQ(plates.num_queries(), num_of_slanting) << "the triangle holds the whole zone: this needs no ray";
}

// The floor of a square well between walls.
Plates well(double side, double depth = 0.2) {
  Plates plates;
  plates.add("floor", Vec3(-0.5 * side, -0.5 * side, 0), Vec3(side, 0, 0), Vec3(0, side, 0));
  for (const double end : {-0.5, 0.5}) {
    plates.add("x" + std::to_string(end), Vec3(end * side, -0.5 * side, 0), Vec3(0, side, 0), Vec3(0, 0, depth));
    plates.add("y" + std::to_string(end), Vec3(-0.5 * side, end * side, 0), Vec3(side, 0, 0), Vec3(0, 0, depth));
  }
  return plates;
}

constexpr double kHigh = 40.0;  // m: where both antennas are
const double kHalfOfWell = std::sqrt(kWavelength * kHigh / 2.0);

// The floor of a well is no larger a mirror than without its walls, which rise far less than the antennas.
TEST(MirrorZone, AFloorBetweenWallsEndsAtThem) {
  Plates plates = well(kHalfOfWell);
  plates.look_at(1e-4, 2e-4);
  EXPECT_NEAR(plates.cover(kHigh, kHigh).share, 0.25, 1e-4);
}

// Waves to 1/0.7 half zones, half of one of which lies before the wall, cross it at 1 - 0.5 * 0.7 of their way down.
TEST(MirrorZone, AFloorGoesOnBehindWallsThatRiseIntoTheWavesToItsZone) {
  for (const double share : {0.99, 1.01}) {
    Plates plates = well(kHalfOfWell, share * 0.65 * kHigh);
    plates.look_at(1e-4, 2e-4);
    EXPECT_NEAR(plates.cover(kHigh, kHigh).share, share < 1.0 ? 0.25 : 1.0, 1e-4);
  }
}

// Facades that rise above the antennas behind the walls of a well, all around it, make its floor no larger.
TEST(MirrorZone, AFloorBetweenLowWallsEndsAtThemHoweverHighTheHousesBehindAre) {
  for (const double behind : {0.01, 3.0, 30.0}) {
    Plates plates = well(kHalfOfWell);
    const double far = 0.5 * kHalfOfWell + behind;
    for (const double end : {-far, far}) {
      plates.add("u" + std::to_string(end), Vec3(end, -far, 0), Vec3(0, 2 * far, 0), Vec3(0, 0, 60));
      plates.add("v" + std::to_string(end), Vec3(-far, end, 0), Vec3(2 * far, 0, 0), Vec3(0, 0, 60));
    }
    plates.look_at(1e-4, 2e-4);
    EXPECT_NEAR(plates.cover(kHigh, kHigh).share, 0.25, 1e-4) << behind;
  }
}

// Walls that rise above the antennas in the planes of the low ones, or lean back from them, go on as their images do.
TEST(MirrorZone, AFloorBetweenHighWallsHasNoEdges) {
  for (const double lean : {0.0, 0.1}) {
    Plates plates;
    const double half = 0.5 * kHalfOfWell, top = half + 60 * lean;
    plates.add("floor", Vec3(-half, -half, 0), Vec3(2 * half, 0, 0), Vec3(0, 2 * half, 0));
    for (const double side : {-1.0, 1.0}) {
      const Vec3 slant(side * (top - half), 0, 60), across(0, side * (top - half), 60);
      plates.add("x" + std::to_string(side), Vec3(side * half, -2, 0), Vec3(0, 4, 0), slant);
      plates.add("y" + std::to_string(side), Vec3(-2, side * half, 0), Vec3(4, 0, 0), across);
    }
    plates.look_at(1e-4, 2e-4);
    EXPECT_NEAR(plates.cover(kHigh, kHigh).share, 1.0, 1e-4) << lean;
  }
}

// Born and Wolf, 8.7: sqrt(j) times the integral of exp(-j pi x^2) from -infinity to the edge; here by Simpson's rule from
// 0.
TEST(MirrorZone, TheFieldBesideAnEdgeIsFresnelsIntegral) {
  const std::complex<double> root_j(std::sqrt(0.5), std::sqrt(0.5));
  for (const double within : {0.0, 0.1, 0.5, 1.0, 1.7, 4.0}) {
    constexpr int kSteps = 4000;
    std::complex<double> sum = 0.0;
    for (int k = 0; k <= kSteps; ++k) {
      const double x = within * k / kSteps, weight = k == 0 || k == kSteps ? 1.0 : k % 2 ? 4.0 : 2.0;
      sum += weight * std::polar(1.0, -kPi * x * x) * (within / kSteps / 3.0);
    }
    EXPECT_LT(std::abs(field_beside_edge(within) - (0.5 + root_j * sum)), kRational) << within;
  }
}

}  // namespace
}  // namespace echopath::test_mirror_zone
