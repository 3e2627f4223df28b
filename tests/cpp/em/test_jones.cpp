// Polarised reflection and physical optics against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "echopath/em/fresnel.h"
#include "echopath/em/jones.h"

namespace echopath {
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

TEST(Jones, ConductorIsItsPhysicalOptics) {
  std::mt19937 random(5);
  const Material metal = Material::metal();
  for (int i = 0; i < 200; ++i) {
    const Case at = random_case(random);
    const double cos_incidence = -at.direction.dot(at.normal);
    const FieldVector radiated =
        radiated_field(at.field, at.direction, at.normal, at.out, mode_coefficients(metal, 77e9, cos_incidence));
    FieldVector expected = -(at.field * cos_incidence + dot(at.normal, at.field) * at.direction.cast<std::complex<double>>());
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
    const ModeCoefficients modes = mode_coefficients(glass, 77e9, cos_incidence);
    const Vec3 mirrored = at.direction + 2.0 * cos_incidence * at.normal;
    const FieldVector reflected = reflected_field(at.field, at.direction, at.normal, modes);
    EXPECT_LT((radiated_field(at.field, at.direction, at.normal, mirrored, modes) - cos_incidence * reflected).norm(), 10 * kRounding);
    EXPECT_LT(std::abs(dot(mirrored, reflected)), kRounding);
    EXPECT_LT(std::abs(modes.te - fresnel_te(*glass.permittivity, cos_incidence)), kRounding);
  }
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
      reflected_field(field, -Vec3::UnitZ(), Vec3::UnitZ(), mode_coefficients(dielectric, 77e9, 1.0));
  EXPECT_LT((reflected - fresnel_te(*dielectric.permittivity, 1.0) * field).norm(), kRounding);
}

TEST(Jones, ComponentsAreThoseAcrossTheDirection) {
  EXPECT_LT((transverse_components(Vec3::UnitZ(), Vec3::UnitX()) - Eigen::Vector2d(0, 1)).norm(), kRounding);
  EXPECT_LT((transverse_components(Vec3::UnitY(), Vec3::UnitX()) - Eigen::Vector2d(1, 0)).norm(), kRounding);
  EXPECT_LT((transverse_components(Vec3(0.3, 0, 1), Vec3::UnitX()) - Eigen::Vector2d(0, 1)).norm(), kRounding);
  EXPECT_EQ(transverse_components(Vec3::UnitX(), Vec3::UnitX()), Eigen::Vector2d::Zero());
}

}  // namespace
}  // namespace echopath
