// Lobes of rough surfaces: each holds all that is scattered, at every angle, and directions are drawn as the density says.
#include <gtest/gtest.h>

#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"
#include "echopath/em/surface/diffuse_lobe.h"

namespace echopath::test_diffuse_lobe {
namespace {

constexpr double kQuadrature = 2e-4;  // midpoints of 800 rings
constexpr double kClosedForm = 1e-12;

Material lobed(int exponent, double share = 0.0, int back = 0) {
  Material material;
  material.reflectivity = 0.5;
  material.scattering = 1.0;
  material.lobe_exponent = exponent;
  material.backscatter_share = share;
  material.backscatter_exponent = back;
  return material;
}

Vec3 direction_at(double cosine, double azimuth) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

// The wave comes down at `cos_in` from the normal, which is z.
Vec3 incoming(double cos_in) { return -direction_at(cos_in, 0.3); }

// Integrates over the half space by midpoints. Round each ring a lobe is a trigonometric polynomial whose degree is its
// exponent, at most 20 here, and its moments are of one degree more: that many sectors sum them exactly.
template <class Function>
double integral(const Function& function) {
  constexpr int kRings = 800, kSectors = 32;
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) sum += function(direction_at((i + 0.5) / kRings, kTwoPi * (j + 0.5) / kSectors));
  }
  return sum * kTwoPi / (double{kRings} * kSectors);
}

TEST(DiffuseLobe, HoldsAllThatIsScatteredAtEveryAngle) {
  const Vec3 normal = Vec3::UnitZ();
  for (const Material& material : {lobed(1), lobed(4), lobed(9), lobed(7, 0.3), lobed(6, 0.2, 20), lobed(3, 1.0)}) {
    const DiffuseLobe lobe(material);
    for (const double cos_in : {1.0, 0.7, 0.2, 0.02}) {
      const double whole = integral([&](const Vec3& out) { return lobe({incoming(cos_in), normal, out}); });
      EXPECT_NEAR(whole, 1.0, kQuadrature) << material.lobe_exponent << " at " << cos_in;
    }
  }
}

// With the exponent 1, the integral of (1 + cos psi)/2 is pi (1 + cos(in)/2).
TEST(DiffuseLobe, OfExponentOneIsItsClosedForm) {
  const DiffuseLobe lobe(lobed(1));
  const Vec3 in = incoming(0.6), out = direction_at(0.4, 1.1), mirrored(in[0], in[1], -in[2]);
  EXPECT_NEAR(lobe({in, Vec3::UnitZ(), out}), 0.5 * (1.0 + mirrored.dot(out)) / (kPi * (1.0 + 0.5 * 0.6)), kClosedForm);
}

TEST(DiffuseLobe, LooksBackWhereItIsAsked) {
  const DiffuseLobe lobe(lobed(20, 0.25));
  const Vec3 in = incoming(0.3), normal = Vec3::UnitZ(), ahead(in[0], in[1], -in[2]);
  const double forward = lobe({in, normal, ahead}), back = lobe({in, normal, -in});
  EXPECT_NEAR(back / forward, 0.25 / 0.75, 1e-9);
}

// A lobe falls by the power of (1 + cos psi)/2 that its own exponent is.
TEST(DiffuseLobe, FallsBesideTheWayBackByTheExponentOfThatSide) {
  const DiffuseLobe lobe(lobed(3, 1.0, 20));
  const Vec3 in = incoming(0.6), normal = Vec3::UnitZ(), beside = direction_at(0.6, 0.5);
  EXPECT_NEAR(lobe({in, normal, beside}) / lobe({in, normal, -in}), std::pow(0.5 * (1.0 - in.dot(beside)), 20), kClosedForm);
}

TEST(DiffuseLobe, IsLambertsWithoutAnExponent) {
  const DiffuseLobe lobe(lobed(0));
  EXPECT_TRUE(lobe.is_lambert());
  EXPECT_NEAR(lobe({incoming(0.5), Vec3::UnitZ(), direction_at(0.4, 2.0)}), 0.4 / kPi, kClosedForm);
  EXPECT_EQ(lobe.over_lambert({incoming(0.5), Vec3::UnitZ(), direction_at(0.4, 2.0)}), 1.0);
}

TEST(DiffuseLobe, TakesTheNormalOfEitherSide) {
  const DiffuseLobe lobe(lobed(5, 0.4, 2));
  const Vec3 in = incoming(0.5), out = direction_at(0.4, 2.0);
  EXPECT_EQ(lobe({in, Vec3::UnitZ(), out}), lobe({in, -Vec3::UnitZ(), out}));
  EXPECT_EQ(lobe({in, Vec3::UnitZ(), direction_at(-0.4, 2.0)}), 0.0);
  EXPECT_EQ(lobe.over_lambert({in, Vec3::UnitZ(), out}), lobe.over_lambert({in, -Vec3::UnitZ(), out}));
  EXPECT_EQ(lobe.density_over_lambert({in, Vec3::UnitZ(), out}), lobe.density_over_lambert({in, -Vec3::UnitZ(), out}));
}

// Exchanging both ends changes the lobe by the ratio of the integrals at both angles of incidence.
TEST(DiffuseLobe, IsReciprocalUpToItsIntegrals) {
  const DiffuseLobe lobe(lobed(1));
  const Vec3 in = incoming(0.9), out = direction_at(0.2, 2.5), normal = Vec3::UnitZ();
  const double there = lobe({in, normal, out}), back = lobe({-out, normal, -in});
  EXPECT_NEAR(there / back, (1.0 + 0.5 * 0.2) / (1.0 + 0.5 * 0.9), kClosedForm);
}

TEST(DiffuseLobe, DrawsDirectionsAsItsDensitySays) {
  const Vec3 normal = Vec3::UnitZ();
  constexpr int kDraws = 40000;
  for (const Material& material : {lobed(4), lobed(6, 0.3, 12)}) {
    const DiffuseLobe lobe(material);
    for (const double cos_in : {0.9, 0.1}) {
      const Vec3 in = incoming(cos_in);
      EXPECT_NEAR(integral([&](const Vec3& out) { return lobe.density({in, normal, out}); }), 1.0, kQuadrature);
      Vec3 sum = Vec3::Zero();
      double whole = 0.0;
      for (uint64_t i = 0; i < kDraws; ++i) {
        const Vec3 out = lobe.sample(in, normal, uniform2(1, Stream::kBounce, i, 0));
        ASSERT_GT(out.dot(normal), 0.0);
        ASSERT_NEAR(out.norm(), 1.0, kClosedForm);
        sum += out;
        whole += lobe({in, normal, out}) / lobe.density({in, normal, out});
      }
      EXPECT_NEAR(whole / kDraws, 1.0, 0.02);
      for (int axis = 0; axis < 3; ++axis) {
        const double mean = integral([&](const Vec3& out) { return lobe.density({in, normal, out}) * out[axis]; });
        EXPECT_NEAR(sum[axis] / kDraws, mean, 0.015) << axis;
      }
    }
  }
}

TEST(Material, RefusesLobesThatAreNone) {
  EXPECT_THROW(lobed(-1).validate(), std::invalid_argument);
  EXPECT_THROW(lobed(101).validate(), std::invalid_argument);
  EXPECT_THROW(lobed(0, 0.5).validate(), std::invalid_argument);
  EXPECT_THROW(lobed(4, 1.5).validate(), std::invalid_argument);
  EXPECT_THROW(lobed(4, 0.0, 3).validate(), std::invalid_argument);
  EXPECT_NO_THROW(lobed(4, 0.5, 3).validate());
}

}  // namespace
}  // namespace echopath::test_diffuse_lobe
