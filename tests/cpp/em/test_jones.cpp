// Polarised reflection and physical optics against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "echopath/base/constants.h"
#include "echopath/em/polarization/mirrored_fields.h"
#include "echopath/em/polarization/transverse_formula.h"
#include "echopath/em/surface/fresnel.h"
#include "echopath/em/surface/surface_response.h"

namespace echopath::test_jones {
namespace {

constexpr double kRounding = 1e-14;

struct Case {
  Vec3 direction, normal, out;
  FieldVector field;
};

// Random directions, out on the lit side.
Case random_case(std::mt19937& random) {
  std::normal_distribution<double> gauss;
  const auto unit = [&] { return Vec3(gauss(random), gauss(random), gauss(random)).normalized(); };
  Case made;
  made.normal = unit();
  made.direction = unit();
  if (made.direction.dot(made.normal) > 0) made.direction = -made.direction;
  made.out = unit();
  if (made.out.dot(made.normal) < 0) made.out = -made.out;
  const TransverseBasis basis = transverse_basis(made.direction);
  made.field = std::complex<double>(gauss(random), gauss(random)) * basis.horizontal.cast<std::complex<double>>() +
               std::complex<double>(gauss(random), gauss(random)) * basis.vertical.cast<std::complex<double>>();
  return made;
}

std::complex<double> dot(const Vec3& a, const FieldVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Along the axes of the direction at the trace.
Eigen::Vector2d transverse_components(const Vec3& polarization, const Vec3& direction, const Vec3& at_trace) {
  const auto unpacked = [](const Vec3& v) { return VectorOf<double>{v[0], v[1], v[2]}; };
  const VectorOf<double> line = unpacked(direction);
  const TransverseOf<double> found =
      transverse_of<ScalarMath>(unpacked(polarization), line, axes_across<ScalarMath>(unpacked(at_trace)));
  return {found.horizontal, found.vertical};
}
Eigen::Vector2d transverse_components(const Vec3& polarization, const Vec3& direction) {
  return transverse_components(polarization, direction, direction);
}

TEST(Jones, ConductorIsItsPhysicalOptics) {
  std::mt19937 random(5);
  const Material metal = Material::metal();
  for (int i = 0; i < 200; ++i) {
    const Case at = random_case(random);
    const double cos_incidence = -at.direction.dot(at.normal);
    const FieldVector radiated =
        radiated_field(at.field, at.direction, at.normal, at.out, SurfaceModel(metal, 77e9).modes(cos_incidence));
    FieldVector expected =
        -(at.field * cos_incidence + dot(at.normal, at.field) * at.direction.cast<std::complex<double>>());
    expected -= dot(at.out, expected) * at.out.cast<std::complex<double>>();
    EXPECT_LT((radiated - expected).norm(), kRounding * 10);
  }
}

TEST(Jones, SpecularRadiationIsTheReflectedFieldTimesTheCosine) {
  std::mt19937 random(6);
  Material glass;
  glass.permittivity = std::complex<double>(6.3, -0.4);
  for (int i = 0; i < 200; ++i) {
    const Case at = random_case(random);
    const double cos_incidence = -at.direction.dot(at.normal);
    const ModeCoefficients modes = SurfaceModel(glass, 77e9).modes(cos_incidence);
    const Vec3 mirrored = at.direction + 2.0 * cos_incidence * at.normal;
    const FieldVector reflected = reflected_field(at.field, at.direction, at.normal, modes);
    EXPECT_LT((radiated_field(at.field, at.direction, at.normal, mirrored, modes) - cos_incidence * reflected).norm(),
              10 * kRounding);
    EXPECT_LT(std::abs(dot(mirrored, reflected)), kRounding);
    EXPECT_LT(std::abs(modes.te - fresnel_te(*glass.permittivity, cos_incidence)), kRounding);
  }
}

// The fields before and behind a conductor add up to one at right angles to it; scattering leaves less behind it.
TEST(Jones, AMirrorMayBeMetFromEitherSide) {
  std::mt19937 random(8);
  Material metal;
  metal.conductor = true;
  metal.scattering = 0.6;
  const SurfaceModel model(metal, 77e9);
  for (int i = 0; i < 50; ++i) {
    const Case at = random_case(random);
    for (const Vec3& normal : {at.normal, Vec3(-at.normal)}) {
      FieldVector behind = at.field;
      Vec3 direction = at.direction;
      carry_over_mirror({&behind, 1}, direction, normal, model);
      EXPECT_LT((at.field + behind / 0.8).cross(at.normal.cast<std::complex<double>>()).norm(), 10 * kRounding);
      EXPECT_LT((direction - at.direction + 2.0 * at.direction.dot(at.normal) * at.normal).norm(), kRounding);
    }
  }
}

// A rough mirror loses less at a slant, by Ament's exp(-2 (k sigma cos)^2).
TEST(Jones, ARoughMirrorLosesLessAtASlant) {
  Material metal = Material::metal();
  metal.roughness_height = 0.4e-3;
  const double cosine = 0.5, phase = kTwoPi * 77e9 / kSpeedOfLight * metal.roughness_height * cosine;
  Vec3 direction(std::sqrt(0.75), 0.0, -cosine);
  FieldVector field(0.0, 1.0, 0.0);
  carry_over_mirror({&field, 1}, direction, Vec3::UnitZ(), SurfaceModel(metal, 77e9));
  EXPECT_NEAR(field.norm(), std::exp(-2.0 * phase * phase), 1e-12);
}

// Rows are components, columns are launches.
TEST(Jones, MatricesTakeLaunchesToComponents) {
  const FieldVector x = Vec3::UnitX().cast<std::complex<double>>(), y = Vec3::UnitY().cast<std::complex<double>>();
  const JonesMatrix matrix = components({FieldVector(y), FieldVector(3.0 * y)}, {x, y});
  EXPECT_EQ(matrix, (JonesMatrix{0.0f, 0.0f, 1.0f, 3.0f}));
}

TEST(Jones, NothingRadiatesAlongItself) {
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    const Case at = random_case(random);
    const FieldVector radiated = radiated_field(at.field, at.direction, at.normal, at.out, {-1.0, 1.0});
    EXPECT_LT(std::abs(dot(at.out, radiated)), kRounding * 10);
  }
}

TEST(Jones, NormalIncidenceHasNoPreferredPlane) {
  const FieldVector field(0.6, std::complex<double>(0.0, 0.8), 0.0);
  Material dielectric;
  dielectric.permittivity = std::complex<double>(4.0, -0.2);
  const FieldVector reflected =
      reflected_field(field, -Vec3::UnitZ(), Vec3::UnitZ(), SurfaceModel(dielectric, 77e9).modes(1.0));
  EXPECT_LT((reflected - fresnel_te(*dielectric.permittivity, 1.0) * field).norm(), kRounding);
}

TEST(Jones, ComponentsAreThoseAcrossTheDirection) {
  EXPECT_LT((transverse_components(Vec3::UnitZ(), Vec3::UnitX()) - Eigen::Vector2d(0, 1)).norm(), kRounding);
  EXPECT_LT((transverse_components(Vec3::UnitY(), Vec3::UnitX()) - Eigen::Vector2d(1, 0)).norm(), kRounding);
  EXPECT_LT((transverse_components(Vec3(0.3, 0, 1), Vec3::UnitX()) - Eigen::Vector2d(0, 1)).norm(), kRounding);
}

// The field of an antenna that has no null along its polarisation is one vector of the world there, which it receives as
// well as sends: two such antennas in one place see a mirror across the line as they see any other.
TEST(Jones, FieldAlongThePolarisationIsTheSameForBothSenses) {
  for (const Vec3& direction : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ()), Vec3(0.6, 0.0, -0.8)}) {
    Vec3 fields[2];
    for (const int sense : {0, 1}) {
      const Vec3 along = sense == 0 ? direction : Vec3(-direction);
      const TransverseBasis basis = transverse_basis(along);
      const Eigen::Vector2d found = transverse_components(direction, along);
      fields[sense] = found[0] * basis.horizontal + found[1] * basis.vertical;
      EXPECT_NEAR(fields[sense].norm(), 1.0, kRounding);
    }
    EXPECT_LT((fields[0] - fields[1]).norm(), kRounding);
  }
}

// The horizontal axis turns round with the direction of travel and the vertical one does not, along z too: what an antenna
// sends along a direction is what it receives from there, but for the sign of one component.
TEST(Jones, ComponentsOfTheOppositeDirectionDifferInOneSign) {
  std::mt19937 random(6);
  for (int i = 0; i < 100; ++i) {
    const Case at = random_case(random);
    const Vec3 direction = i == 0 ? Vec3::UnitZ() : at.direction;
    const TransverseBasis there = transverse_basis(direction), back = transverse_basis(-direction);
    EXPECT_LT((there.horizontal + back.horizontal).norm() + (there.vertical - back.vertical).norm(), kRounding);
    EXPECT_LT((there.horizontal.cross(there.vertical) - direction).norm(), kRounding);
    const Vec3 across = at.out - at.out.dot(direction) * direction;
    const Eigen::Vector2d found = transverse_components(at.out, direction);
    EXPECT_NEAR(found[0], across.normalized().dot(there.horizontal), 1e3 * kRounding);  // of vectors that may all but meet
    EXPECT_NEAR(found[1], across.normalized().dot(there.vertical), 1e3 * kRounding);
    EXPECT_EQ(transverse_components(at.out, -direction), Eigen::Vector2d(-found[0], found[1]));
  }
}

// The least rotation from one direction to another turns about the normal of their plane, about z as elsewhere.
TEST(Jones, AxesAreCarriedByTheLeastRotation) {
  std::mt19937 random(7);
  for (int i = 0; i < 100; ++i) {
    const Case at = random_case(random);
    const Vec3 traced = i < 50 ? at.direction : Vec3(0.01 * at.direction - Vec3::UnitZ()).normalized();
    const Vec3 direction = (traced + 0.02 * at.normal).normalized();
    const TransverseBasis basis = transverse_basis(traced);
    const auto turn = Eigen::Quaterniond::FromTwoVectors(traced, direction);
    const Vec3 across = (at.out - at.out.dot(direction) * direction).normalized();
    const Eigen::Vector2d found = transverse_components(at.out, direction, traced);
    EXPECT_NEAR(found[0], across.dot(turn * basis.horizontal), 1e3 * kRounding);
    EXPECT_NEAR(found[1], across.dot(turn * basis.vertical), 1e3 * kRounding);
  }
}

TEST(Fresnel, BothModesAtOnceAreEachOfThem) {
  for (const double cosine : {1.0, 0.7, 0.1}) {
    const FresnelModes both = fresnel_modes({4.0, -0.2}, cosine);
    EXPECT_EQ(both.te, fresnel_te({4.0, -0.2}, cosine));
    EXPECT_EQ(both.tm, fresnel_tm({4.0, -0.2}, cosine));
  }
}

// --- Diffuse hits ---

TEST(Scattering, MetalWithoutDepolarisationIsAFacetThatMirrors) {
  std::mt19937 random(8);
  for (int i = 0; i < 100; ++i) {
    const Case at = random_case(random);
    const Vec3 facet = (at.out - at.direction).normalized();
    const FieldVector scattered = scattered_field(at.field, at.direction, at.out, 1.0, {});
    EXPECT_LT((scattered - reflected_field(at.field, at.direction, facet, {-1.0, 1.0})).norm(), 20 * kRounding);
  }
}

TEST(Scattering, EveryHitKeepsThePowerOfItsFacets) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  constexpr double kReflection = 0.4;
  for (int i = 0; i < 200; ++i) {
    const Case at = random_case(random);
    const Depolarization turn{0.5 * unit(random), kPi * unit(random)};
    const FieldVector scattered = scattered_field(at.field, at.direction, at.out, kReflection, turn);
    const double power = kReflection * kReflection * at.field.squaredNorm();
    EXPECT_NEAR(scattered.squaredNorm(), power, 20 * kRounding * at.field.squaredNorm());
    EXPECT_LT(std::abs(dot(at.out, scattered)), 20 * kRounding * at.field.norm());
  }
}

TEST(Scattering, ExchangedEndsTransposeTheMatrix) {
  std::mt19937 random(10);
  for (int i = 0; i < 100; ++i) {
    const Case at = random_case(random), other = random_case(random);
    const Depolarization turn{0.3, 0.03 * i};
    const FieldVector received = other.field - dot(at.out, other.field) * at.out.cast<std::complex<double>>();
    const FieldVector forth = scattered_field(at.field, at.direction, at.out, 1.0, turn);
    const FieldVector back = scattered_field(received, -at.out, -at.direction, 1.0, turn);
    const std::complex<double> one = received.transpose() * forth, other_way = at.field.transpose() * back;
    EXPECT_LT(std::abs(one - other_way), 100 * kRounding);
  }
}

// Backscatter, averaged over the axes of the hits; with 1/4 hh : hv : hh vv* = 3 : 1 : 1, a cloud of needles.
TEST(Scattering, MeanPowersAreThoseOfSurfacesWithoutAxis) {
  constexpr int kAxes = 64;
  for (const double share : {0.0, 0.1, 0.25, 0.5}) {
    for (const double slant : {0.0, 0.4, kPi / 4}) {
      const Vec3 co(0.0, std::sin(slant), std::cos(slant)), cross(0.0, std::cos(slant), -std::sin(slant));
      double co_power = 0.0, cross_power = 0.0;
      std::complex<double> coherence = 0.0;
      for (int i = 0; i < kAxes; ++i) {
        const auto echo = [&](const Vec3& sent, const Vec3& received) {
          return dot(received, scattered_field(sent.cast<std::complex<double>>(), Vec3::UnitX(), -Vec3::UnitX(), 1.0,
                                               {share, kPi * i / kAxes}));
        };
        co_power += std::norm(echo(co, co)) / kAxes;
        cross_power += std::norm(echo(co, cross)) / kAxes;
        coherence += echo(co, co) * std::conj(echo(cross, cross)) / double{kAxes};
      }
      EXPECT_NEAR(co_power, 1.0 - share, 100 * kRounding);
      EXPECT_NEAR(cross_power, share, 100 * kRounding);
      EXPECT_LT(std::abs(coherence - (1.0 - 3.0 * share)), 100 * kRounding);
    }
  }
}

}  // namespace
}  // namespace echopath::test_jones
