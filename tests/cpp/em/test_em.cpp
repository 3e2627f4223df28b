#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/expect_error.h"
#include "echopath/base/constants.h"
#include "echopath/em/surface/backscatter.h"
#include "echopath/em/surface/coherent_share.h"
#include "echopath/em/surface/fresnel.h"
#include "echopath/em/surface/surface_response.h"

namespace echopath::test_em {
namespace {

using Complex = std::complex<double>;
const Complex kEpsilon(4.0, -0.2);
constexpr double kTableTolerance = 6e-6;  // the published table has five digits
constexpr double kRounding = 1e-15;
constexpr double kThreeDigits = 5e-4;  // of figures printed with three decimals
// Of the first order in the cosine, 1e-9: 2 / sqrt(eps - 1) times that for TE, eps times more for TM.
constexpr double kGrazingTe = 1e-8, kGrazing = 1e-7;
constexpr double kConductor = 1e-5;  // of the first order in 1 / sqrt(eps), 1e-6

double cos_deg(double angle_deg) { return std::cos(angle_deg * kPi / 180.0); }

// |Gamma| of eps = 4 - 0.2j, computed independently for the physics notes of the project.
TEST(Fresnel, MagnitudesMatchTheReferenceTable) {
  const double table[][3] = {
      {0, .33384, .33384}, {45, .45196, .20426}, {60, .56625, .05290}, {80, .81886, .42958}, {89, .98008, .92252}};
  for (const auto& [angle_deg, te, tm] : table) {
    EXPECT_NEAR(std::abs(fresnel_te(kEpsilon, cos_deg(angle_deg))), te, kTableTolerance) << angle_deg;
    EXPECT_NEAR(std::abs(fresnel_tm(kEpsilon, cos_deg(angle_deg))), tm, kTableTolerance) << angle_deg;
  }
}

TEST(Fresnel, BrewsterAngleHasNoTmReflection) {
  const double cos_brewster = 1.0 / std::sqrt(1.0 + 4.0);  // tan = sqrt(eps)
  EXPECT_LT(std::abs(fresnel_tm(Complex(4.0, 0.0), cos_brewster)), kRounding);
}

// Total reflection, with the phases of Fresnel's rhomb (Born and Wolf, 1.5.4) for a wave that decays behind the surface.
TEST(Fresnel, AThinnerMediumReflectsAllBeyondTheCriticalAngle) {
  const double epsilon = 0.4, cosine = cos_deg(60.0), sine = std::sqrt(1.0 - cosine * cosine);
  const double decay = std::sqrt(sine * sine - epsilon);
  const Complex te = std::polar(1.0, 2.0 * std::atan(decay / cosine)),
                tm = std::polar(1.0, 2.0 * std::atan(decay / (epsilon * cosine)));
  EXPECT_LT(std::abs(fresnel_te(epsilon, cosine) - te), kRounding);
  EXPECT_LT(std::abs(fresnel_tm(epsilon, cosine) - tm), kRounding);
  EXPECT_EQ(fresnel_te(0.75, 0.5), 1.0);  // at that angle
}

TEST(Fresnel, NormalIncidenceModesAreOpposite) {
  EXPECT_LT(std::abs(fresnel_te(kEpsilon, 1.0) + fresnel_tm(kEpsilon, 1.0)), kRounding);
}

TEST(Fresnel, GrazingIncidenceTendsToMinusOne) {
  EXPECT_LT(std::abs(fresnel_te(kEpsilon, 1e-9) + 1.0), kGrazingTe);
  EXPECT_LT(std::abs(fresnel_tm(kEpsilon, 1e-9) + 1.0), kGrazing);
}

TEST(Fresnel, GoodConductorTendsToPerfectConductor) {
  EXPECT_LT(std::abs(fresnel_te(Complex(1.0, -1e12), 0.5) + 1.0), kConductor);
  EXPECT_LT(std::abs(fresnel_tm(Complex(1.0, -1e12), 0.5) - 1.0), kConductor);
}

// Power factors at normal incidence and 80 degrees, 77 GHz.
TEST(Roughness, AmentPowerFactorMatchesReference) {
  const auto power = [](double height, double angle_deg) {
    Material rough = Material::metal();
    rough.roughness_height = height;
    return std::pow(respond(rough, 77e9, cos_deg(angle_deg), PolarizationMode::kTe).coherent, 2);
  };
  EXPECT_NEAR(power(0.1e-3, 0), 0.901, kThreeDigits);
  EXPECT_NEAR(power(0.3e-3, 0), 0.392, kThreeDigits);
  EXPECT_NEAR(power(0.5e-3, 0), 0.074, kThreeDigits);
  EXPECT_NEAR(power(1e-3, 80), 0.730, kThreeDigits);
  Material rough = Material::metal();
  rough.roughness_height = 0.3e-3;
  EXPECT_NEAR(coherent_share(rough, kSpeedOfLight / 77e9), 0.392, kThreeDigits);
}

TEST(Roughness, WhatIsNotScatteredKeepsItsPhase) {
  Material scattering = Material::metal();
  scattering.scattering = 0.6;
  EXPECT_NEAR(coherent_share(scattering, 0.004), 0.64, kRounding);
}

// A white Lambert surface has 4 cos(incidence)^2 (Skolnik, Radar Handbook), less what it sends across the polarisation.
TEST(Backscatter, WhiteSurfacesFollowLambertsLaw) {
  Material white;
  white.reflectivity = 1.0;
  white.scattering = 1.0;
  EXPECT_NEAR(backscatter_coefficient(white, 77e9, 0.7), 4.0 * 0.49, 1e-12);
  white.cross_polarization = 0.25;
  EXPECT_NEAR(backscatter_coefficient(white, 77e9, 0.7), 3.0 * 0.49, 1e-12);
}

TEST(SurfaceResponse, CoherentAndDiffusePowerAddUp) {
  Material rough;
  rough.permittivity = kEpsilon;
  rough.roughness_height = 0.4e-3;
  Material scattering;
  scattering.reflectivity = 0.34;
  scattering.scattering = 0.6;
  for (const Material& material : {rough, scattering, Material::metal()}) {
    material.validate();
    const SurfaceResponse response = respond(material, 77e9, 0.3, PolarizationMode::kTm);
    EXPECT_NEAR(response.coherent * response.coherent + response.diffuse * response.diffuse, 1.0, kRounding);
  }
  EXPECT_NEAR(std::norm(respond(scattering, 77e9, 0.3, PolarizationMode::kTe).gamma), 0.34, kRounding);
}

// At Brewster's angle the mean surface reflects no TM; its facets that face the radar reflect as at normal incidence.
TEST(SurfaceResponse, FacetsReflectAsAtNormalIncidenceInBothModes) {
  Material road;
  road.permittivity = std::complex<double>(4.0, 0.0);
  road.roughness_height = 0.5e-3;
  for (const double angle_deg : {0.0, 30.0, 63.435, 70.0, 89.0}) {
    for (const PolarizationMode mode : {PolarizationMode::kTe, PolarizationMode::kTm}) {
      EXPECT_NEAR(respond(road, 77e9, std::cos(angle_deg * kPi / 180.0), mode).facet, 1.0 / 3.0, kRounding);
    }
  }
  EXPECT_LT(std::abs(respond(road, 77e9, std::cos(63.435 * kPi / 180.0), PolarizationMode::kTm).gamma), 1e-5);
  Material fabric;
  fabric.reflectivity = 0.25;
  EXPECT_NEAR(respond(fabric, 77e9, 0.1, PolarizationMode::kTe).facet, 0.5, kRounding);
  EXPECT_NEAR(respond(Material::metal(), 77e9, 0.1, PolarizationMode::kTm).facet, 1.0, kRounding);
}

TEST(SurfaceResponse, NoAngleReflectsMoreThanArrives) {
  for (const double real : {1.5, 4.0, 9.0, 80.0}) {
    for (const double height : {0.0, 0.2e-3, 1e-3}) {
      Material rough;
      rough.permittivity = std::complex<double>(real, -0.3 * real);
      rough.roughness_height = height;
      for (int angle_deg = 0; angle_deg < 90; ++angle_deg) {
        for (const PolarizationMode mode : {PolarizationMode::kTe, PolarizationMode::kTm}) {
          const SurfaceResponse at = respond(rough, 77e9, std::cos(angle_deg * kPi / 180.0), mode);
          const double coherent = at.coherent * at.coherent * std::norm(at.gamma), diffuse = at.diffuse * at.facet;
          EXPECT_LE(coherent + diffuse * diffuse, 1.0 + kRounding);
        }
      }
    }
  }
}

TEST(SurfaceResponse, ConductivityIsLossOfThePermittivity) {
  Material lossy;
  lossy.permittivity = Complex(4.0, 0.0);
  lossy.conductivity = 0.2 * kTwoPi * 77e9 * kVacuumPermittivity;
  EXPECT_LT(std::abs(respond(lossy, 77e9, 0.7, PolarizationMode::kTe).gamma - fresnel_te(kEpsilon, 0.7)), kRounding);
}

TEST(Material, BadValuesAreNamed) {
  const auto message = [](const Material& material) { return test::error_text([&] { material.validate(); }); };
  Material gain, two = Material::metal(), both, over;
  gain.permittivity = Complex(4.0, 0.2);
  two.reflectivity = 0.5;
  both.reflectivity = 0.5;
  both.scattering = 0.5;
  both.roughness_height = 1e-3;
  over.reflectivity = 1.5;
  EXPECT_NE(message(gain).find("permittivity"), std::string::npos);
  EXPECT_NE(message(two).find("exactly one"), std::string::npos);
  EXPECT_NE(message(both).find("roughness_height"), std::string::npos);
  EXPECT_NE(message(over).find("1.5"), std::string::npos);
  EXPECT_NE(message(Material{}).find("exactly one"), std::string::npos);
}

}  // namespace
}  // namespace echopath::test_em
