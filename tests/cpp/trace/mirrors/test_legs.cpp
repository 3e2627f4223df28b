// Legs over flagged mirrors against images drawn by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "cpp/support/scenes.h"
#include "echopath/trace/frusta/mirror_frusta.h"
#include "echopath/trace/mirrors/coplanar_mirrors.h"
#include "echopath/trace/mirrors/legs.h"

namespace echopath::test_legs {
namespace {

constexpr double kFrequency = 77e9;  // Hz
constexpr double kLifted = 1e-4;     // m: bounces are those of a mesh in single precision

// A floor at z = 0 and a wall at x = 0, both of rough metal, and an antenna before them.
class Corner : public ::testing::Test {
 protected:
  Corner() {
    Material metal = Material::metal(true);
    metal.roughness_height = 0.1e-3;
    const MaterialPtr rough = echopath::testing::share(metal);
    echopath::testing::add_rectangle(scene_, "floor", Vec3(-1, -9, 0), Vec3(9, 0, 0), Vec3(0, 18, 0), rough);
    echopath::testing::add_rectangle(scene_, "wall", Vec3(0, -9, -1), Vec3(0, 18, 0), Vec3(0, 0, 9), rough);
    geometry_.emplace(scene_, PosedScene(scene_, 0.0), Vec3::Zero());
    mirrors_ = find_mirrors(scene_, *geometry_);
    frusta_ = FrustumFinder(mirrors_).find(antenna_, {});
  }

  std::vector<Leg> legs_from(const Vec3& point, const Vec3& normal, int max_mirrors = 2, MirrorSequence skip = -1) const {
    std::vector<Leg> legs;
    LegSearch search;
    LegFinder(*geometry_, mirrors_, kFrequency, Vec3::UnitY())
        .find({point, normal, max_mirrors, skip}, view_of(antenna_, frusta_.frusta), legs, search);
    return legs;
  }
  const Leg* over(const std::vector<Leg>& legs, const std::vector<int>& mirrors) const {
    MirrorSequence sequence = kNoMirrors;
    for (const int mirror : mirrors) sequence = extended(sequence, mirror, mirrors_.size());
    const auto found = std::ranges::find(legs, sequence, &Leg::sequence);
    return found == legs.end() ? nullptr : &*found;
  }

  const Vec3 antenna_{3.0, 0.0, 1.0}, point_{2.0, 0.5, 1.5};
  Scene scene_;
  std::optional<EmbreeScene> geometry_;
  std::vector<Mirror> mirrors_;  // floor, wall
  MirrorFrusta frusta_;
};

// Of Ament's exp(-2 (k sigma cos)^2).
double coherent(double cosine) {
  const double phase = kTwoPi * kFrequency / kSpeedOfLight * 0.1e-3 * cosine;
  return std::exp(-2.0 * phase * phase);
}

TEST_F(Corner, ALegOverTheFloorIsTheLineToTheImage) {
  const std::vector<Leg> legs = legs_from(point_, Vec3::UnitX());
  const Leg* leg = over(legs, {0});
  ASSERT_TRUE(leg);
  const Vec3 line = Vec3(3.0, 0.0, -1.0) - point_;
  const double cosine = -line.z() / line.norm();
  EXPECT_NEAR(leg->length, line.norm(), 1e-12);
  EXPECT_LT((leg->to_antenna - line.normalized()).norm(), 1e-12);
  EXPECT_LT((leg->at_antenna - Vec3(-line.x(), -line.y(), line.z()).normalized()).norm(), kLifted);
  ASSERT_EQ(leg->num_bounces, 1);
  EXPECT_LT((leg->bounces[0].normal - Vec3::UnitZ()).norm(), 1e-12);
  // Conductors count as TE, whose coefficient is -1.
  EXPECT_LT(std::abs(leg->gain + coherent(cosine)), 1e-9);
  EXPECT_NEAR(leg->specular_share, coherent(cosine) * coherent(cosine), 1e-9);
}

TEST_F(Corner, ALegOverBothHasTheProductOfTheirFactors) {
  const std::vector<Leg> legs = legs_from(point_, Vec3(-1.0, 0.0, -1.0).normalized());
  const Leg* leg = over(legs, {1, 0});
  const Leg* other = over(legs, {0, 1});
  ASSERT_TRUE((leg == nullptr) != (other == nullptr));  // of both orders one meets the corner's sides
  if (!leg) leg = other;
  const Vec3 line = Vec3(-3.0, 0.0, -1.0) - point_, unit = line.normalized();
  const double factor = coherent(-unit.x()) * coherent(-unit.z());
  EXPECT_NEAR(leg->length, line.norm(), 1e-12);
  EXPECT_LT((leg->at_antenna - Vec3(unit.x(), -unit.y(), unit.z())).norm(), kLifted);
  EXPECT_LT(std::abs(leg->gain - factor), 1e-9);
  EXPECT_NEAR(leg->specular_share, factor * factor, 1e-9);
}

TEST_F(Corner, LegsLeaveToTheLitSideAlone) {
  const std::vector<Leg> up = legs_from(point_, Vec3::UnitZ()), away = legs_from(point_, -Vec3::UnitX());
  EXPECT_FALSE(over(up, {0}));
  EXPECT_FALSE(over(up, {}));  // the antenna is lower
  EXPECT_FALSE(over(away, {}));
  EXPECT_TRUE(over(away, {1}));
}

TEST_F(Corner, SequencesThatAreLeftOutOrTooLongAreNotThere) {
  const Vec3 normal = Vec3(-1.0, 0.0, -1.0).normalized();
  const MirrorSequence wall = extended(kNoMirrors, 1, 2);
  EXPECT_TRUE(over(legs_from(point_, normal), {1}));
  EXPECT_FALSE(over(legs_from(point_, normal, 2, wall), {1}));
  for (const Leg& leg : legs_from(point_, normal, 1)) EXPECT_LE(leg.num_bounces, 1);
}

// The image over a plane is one, however many mirrors lie in it.
TEST_F(Corner, OfTwoFloorsInOnePlaneTheLastHasTheLeg) {
  const MaterialPtr metal = echopath::testing::share(Material::metal(true));
  echopath::testing::add_rectangle(scene_, "puddle", Vec3(9, 8, 0), Vec3(0, -16, 0), Vec3(-9, 0, 0), metal);
  geometry_.emplace(scene_, PosedScene(scene_, 0.0), Vec3::Zero());
  mirrors_ = find_mirrors(scene_, *geometry_);
  frusta_ = FrustumFinder(mirrors_).find(antenna_, {});
  const std::vector<Leg> legs = legs_from(point_, Vec3::UnitX());
  EXPECT_FALSE(over(legs, {0}));
  const Leg* leg = over(legs, {2});
  ASSERT_TRUE(leg);
  EXPECT_NEAR(leg->length, (Vec3(3.0, 0.0, -1.0) - point_).norm(), 1e-12);
}

// Mirrors that are nearer to each other than rays tell apart: the highest is met, and in one plane the last.
TEST(MirrorsOnEachOther, TheFrontOneIsMet) {
  constexpr double kNear = 1e-6;  // m
  const Vec3 from(0.0, 0.0, 2.0), point(0.1, 0.2, 0.0);
  for (int all = 0; all < 27; ++all) {
    const std::array<int, 3> steps = {all % 3, all / 3 % 3, all / 9};
    Scene scene;
    for (size_t k = 0; k < 3; ++k) {
      echopath::testing::add_rectangle(scene, std::string(1, "abc"[k]), Vec3(-5, -5, kNear * steps[k]), Vec3(10, 0, 0),
                                       Vec3(0, 10, 0), echopath::testing::share(Material::metal(true)));
    }
    const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
    const std::vector<Mirror> mirrors = find_mirrors(scene, geometry);
    size_t front = 0;
    for (size_t k = 1; k < 3; ++k) front = steps[k] >= steps[front] ? k : front;
    for (size_t k = 0; k < 3; ++k) {
      const auto met = hit_in_front(mirrors, static_cast<int>(k), from, point + kNear * steps[k] * Vec3::UnitZ());
      EXPECT_EQ(met ? met->mesh_id : k, front) << ::testing::PrintToString(steps) << " from " << k;
    }
  }
}

// What lies in a mirror's plane sees nothing in it.
TEST_F(Corner, APointOnTheFloorHasNoLegOverIt) { EXPECT_FALSE(over(legs_from(Vec3(2.0, 0.5, 0.0), Vec3::UnitX()), {0})); }

// At normal incidence no plane of incidence is told from another: TE and TM have one field factor there.
TEST(MirrorResponse, ModesAreOneAtNormalIncidence) {
  Material floor;
  floor.permittivity = 4.0;
  const SurfaceModel model(floor, kFrequency);
  const Vec3 direction = Vec3(1e-4, 0.0, -1.0).normalized();
  for (const Vec3& polarization : {Vec3(Vec3::UnitY()), Vec3(Vec3::UnitX())}) {
    const std::complex<double> gamma = respond_as_mirror(model, polarization, direction, Vec3::UnitZ()).gamma;
    EXPECT_LT(std::abs(gamma + 1.0 / 3.0), 1e-6) << polarization.transpose();
  }
}

// Fresnel's coefficients of a permittivity of 4 at 60 degrees; a field upright at both ends keeps the sign of TM.
TEST(MirrorResponse, IsFresnelsAtASlant) {
  Material floor;
  floor.permittivity = 4.0;
  const SurfaceModel model(floor, kFrequency);
  const Vec3 direction(std::sqrt(0.75), 0.0, -0.5);
  const double inside = std::sqrt(4.0 - 0.75);
  const auto gamma = [&](const Vec3& polarization) {
    return respond_as_mirror(model, polarization, direction, Vec3::UnitZ()).gamma;
  };
  EXPECT_LT(std::abs(gamma(Vec3::UnitY()) - (0.5 - inside) / (0.5 + inside)), 1e-12);
  EXPECT_LT(std::abs(gamma(Vec3::UnitZ()) - (2.0 - inside) / (2.0 + inside)), 1e-12);
}

// A sheet so thick that nothing comes back from its other side is a half space.
TEST(MirrorResponse, OfAThickSheetIsThatOfAHalfSpace) {
  Material floor, sheet;
  floor.permittivity = std::complex<double>(5.0, -0.5);
  sheet.layers = {{1.0, *floor.permittivity}};
  const SurfaceModel of_floor(floor, kFrequency), of_sheet(sheet, kFrequency);
  for (const double slant : {0.1, 0.7, 1.3}) {
    const Vec3 direction(std::sin(slant), 0.0, -std::cos(slant));
    for (const Vec3& polarization : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
      const auto gamma = [&](const SurfaceModel& model) {
        return respond_as_mirror(model, polarization, direction, Vec3::UnitZ()).gamma;
      };
      EXPECT_LT(std::abs(gamma(of_floor) - gamma(of_sheet)), 1e-12) << slant << " " << polarization.transpose();
    }
  }
}

// The mode is that of the larger part of the field across the direction of travel, as both ends see it.
TEST(PolarizationMode, IsThatOfTheLargerPartOfTheField) {
  const Vec3 normal = Vec3::UnitZ(), direction = Vec3(1.0, 0.0, -1.0).normalized();
  const auto mode = [&](double te, double along_behind) {
    const Vec3 behind = Vec3(1.0, 0.0, 1.0).normalized();
    return polarization_mode(te * Vec3::UnitY() + along_behind * behind, direction, normal);
  };
  EXPECT_EQ(mode(1.0, 0.0), PolarizationMode::kTe);
  EXPECT_EQ(mode(0.0, 1.0), PolarizationMode::kTm);
  // Half of the power of the other part lies along the direction of one end, and does not count there.
  EXPECT_EQ(mode(0.6, 0.8), PolarizationMode::kTe);
  EXPECT_EQ(mode(0.55, std::sqrt(1.0 - 0.55 * 0.55)), PolarizationMode::kTm);
  // A field nearly along the direction of travel, at both ends, counts as TM, and all are TE at normal incidence.
  const Vec3 grazing(std::cos(0.03), 0.0, -std::sin(0.03));
  EXPECT_EQ(polarization_mode(grazing + 0.05 * Vec3::UnitY(), grazing, normal), PolarizationMode::kTm);
  EXPECT_EQ(polarization_mode(Vec3::UnitX(), Vec3(1e-13, 0.0, -1.0), normal), PolarizationMode::kTe);
}

}  // namespace
}  // namespace echopath::test_legs
