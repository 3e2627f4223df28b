#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/em/layers/sheet_table.h"
#include "echopath/em/surface/surface_response.h"

namespace echopath::test_layers {
namespace {

using Complex = std::complex<double>;
constexpr double kFrequency = 77e9;  // Hz
constexpr double kRounding = 1e-12;
constexpr double kGrazingRounding = 1e-10;  // of differences of cosines as small as 1e-3
constexpr double kInterpolated = 1e-6;
constexpr double kDifference = 1e-6;  // m, of delays by finite differences of a phase
const double kWavenumber = kTwoPi * kFrequency / kSpeedOfLight;
const std::vector<double> kCosines = {1.0, 0.9, 0.6, 0.3, 0.05, 0.001};
const std::vector<Layer> kPane = {{0.004, Complex(6.3, -0.4)}};
const std::vector<Layer> kStack = {
    {0.0001, Complex(9.0, -0.5)}, {0.003, Complex(2.3, 0.0)}, {0.002, Complex(1.2, -0.02), 0.4}};
const std::vector<Layer> kLossless = {{0.0002, 7.0}, {0.003, 2.3}, {0.0011, 4.0}};

struct Pair {
  Complex reflection, transmission;
};

// Airy 1833 for one slab: the sum of a geometric series over the bounces between both faces.
Pair airy(const Layer& slab, double cosine, bool is_te) {
  const Complex q = std::sqrt(slab.permittivity - (1.0 - cosine * cosine));
  const Complex face =
      is_te ? (cosine - q) / (cosine + q) : (slab.permittivity * cosine - q) / (slab.permittivity * cosine + q);
  const Complex through = std::exp(Complex(0.0, -kWavenumber * slab.thickness) * q);
  const Complex sum = 1.0 - face * face * through * through;
  return {face * (1.0 - through * through) / sum, (1.0 - face * face) * through / sum};
}

// The characteristic matrix of Abeles: tangential fields before the stack from those behind it (Born and Wolf, 1.6).
Pair by_matrices(const std::vector<Layer>& layers, double cosine, bool is_te) {
  std::array<Complex, 4> all = {1.0, 0.0, 0.0, 1.0};
  for (const Layer& layer : layers) {
    const Complex eps = layer.permittivity - Complex(0.0, layer.conductivity / (kTwoPi * kFrequency * kVacuumPermittivity));
    const Complex q = std::sqrt(eps - (1.0 - cosine * cosine)), admittance = is_te ? q : eps / q;
    const Complex phase = kWavenumber * layer.thickness * q, c = std::cos(phase), s = Complex(0.0, 1.0) * std::sin(phase);
    all = {all[0] * c + all[1] * s * admittance, all[0] * s / admittance + all[1] * c, all[2] * c + all[3] * s * admittance,
           all[2] * s / admittance + all[3] * c};
  }
  const double outside = is_te ? cosine : 1.0 / cosine;
  const Complex electric = all[0] + all[1] * outside, magnetic = all[2] + all[3] * outside;
  const Complex sum = outside * electric + magnetic, reflection = (outside * electric - magnetic) / sum;
  // In the plane of incidence the sign is that of the magnetic field (fresnel_tm).
  return {is_te ? reflection : -reflection, 2.0 * outside / sum};
}

void expect_near(Complex found, Complex expected) { EXPECT_LT(std::abs(found - expected), kRounding) << found << expected; }

TEST(LayerStack, OneLayerIsAirysSlab) {
  for (const double cosine : kCosines) {
    const LayerStack slab(kPane, kFrequency);
    const Pair te = airy(kPane[0], cosine, true), tm = airy(kPane[0], cosine, false);
    expect_near(slab.reflection(cosine).te, te.reflection);
    expect_near(slab.reflection(cosine).tm, tm.reflection);
    expect_near(slab.transmission(cosine).te, te.transmission);
    expect_near(slab.transmission(cosine).tm, tm.transmission);
  }
}

TEST(LayerStack, SeveralLayersAreTheirCharacteristicMatrices) {
  for (const double cosine : kCosines) {
    const LayerStack stack(kStack, kFrequency);
    const Pair te = by_matrices(kStack, cosine, true), tm = by_matrices(kStack, cosine, false);
    expect_near(stack.reflection(cosine).te, te.reflection);
    expect_near(stack.reflection(cosine).tm, tm.reflection);
    expect_near(stack.transmission(cosine).te, te.transmission);
    expect_near(stack.transmission(cosine).tm, tm.transmission);
  }
}

TEST(LayerStack, LosslessStacksConservePower) {
  const LayerStack stack(kLossless, kFrequency);
  for (const double cosine : kCosines) {
    const FresnelModes reflected = stack.reflection(cosine);
    const LayerTransmission passed = stack.transmission(cosine);
    EXPECT_NEAR(std::norm(reflected.te) + std::norm(passed.te), 1.0, kRounding);
    EXPECT_NEAR(std::norm(reflected.tm) + std::norm(passed.tm), 1.0, kRounding);
  }
}

TEST(LayerStack, BothSidesPassTheSameAndReflectDifferently) {
  std::vector<Layer> reversed = kStack;
  std::reverse(reversed.begin(), reversed.end());
  const LayerStack front(kStack, kFrequency), back(reversed, kFrequency);
  for (const double cosine : kCosines) {
    expect_near(front.transmission(cosine).te, back.transmission(cosine).te);
    expect_near(front.transmission(cosine).tm, back.transmission(cosine).tm);
  }
  EXPECT_GT(std::abs(front.reflection(0.6).te - back.reflection(0.6).te), 0.01);
}

TEST(LayerStack, HalfAWavelengthIsAWindow) {
  const double inside = std::sqrt(4.0 - 0.19);  // at a cosine of 0.9
  const LayerStack stack(std::vector<Layer>{{kPi / (kWavenumber * inside), 4.0}}, kFrequency);
  EXPECT_LT(std::abs(stack.reflection(0.9).te), kRounding);
  EXPECT_NEAR(std::abs(stack.transmission(0.9).tm), 1.0, kRounding);
}

TEST(LayerStack, AirChangesNothing) {
  const LayerStack stack(std::vector<Layer>{{0.3, 1.0}}, kFrequency);
  for (const double cosine : kCosines) {
    EXPECT_LT(std::abs(stack.over_free_space(cosine).te - 1.0), kGrazingRounding);
    EXPECT_LT(std::abs(stack.reflection(cosine).tm), kGrazingRounding);
    EXPECT_NEAR(stack.offset(cosine), 0.0, kGrazingRounding);
  }
}

// A thinner medium may lie at an angle beyond that of total reflection, where the ray has no way through.
TEST(LayerStack, OffsetsOfLayersAddUp) {
  const Layer slab{0.004, 6.25}, pane{0.002, 2.3}, thin{0.001, 0.5};
  const auto offset = [](std::vector<Layer> layers) { return LayerStack(layers, kFrequency).offset(0.4); };
  EXPECT_NEAR(offset({slab, pane}), offset({slab}) + offset({pane}), kRounding);
  EXPECT_EQ(offset({thin}), 0.0);
}

TEST(LayerStack, TwoLayersOfAirChangeNothing) {
  const LayerStack stack(std::vector<Layer>{{0.3, 1.0}, {0.2, 1.0}}, kFrequency);
  EXPECT_LT(std::abs(stack.over_free_space(0.6).te - 1.0), kGrazingRounding);
}

TEST(LayerStack, AWaveAlongTheFacesEntersNothing) {
  const LayerStack stack(std::vector<Layer>{{0.3, 1.0}}, kFrequency);
  EXPECT_EQ(stack.reflection(0.0).te, -1.0);
  EXPECT_EQ(stack.reflection(0.0).tm, -1.0);
  EXPECT_EQ(stack.transmission(0.0).tm, 0.0);
}

TEST(LayerStack, ThickMetalReflectsAllAndPassesNothing) {
  const LayerStack stack(std::vector<Layer>{{1.0, 1.0, 1e7}}, kFrequency);
  EXPECT_NEAR(std::abs(stack.reflection(0.7).te), 1.0, 1e-3);  // skin depth .6 um
  EXPECT_EQ(std::abs(stack.transmission(0.7).te), 0.0);
  EXPECT_EQ(std::abs(stack.transmission(0.0).te), 0.0);
}

// Snell's law within the slab, and Fermat's principle for the whole way of a bent ray from point to point.
TEST(SheetModel, PhaseOfTheStraightLegIsThatOfTheBentRay) {
  const double length = 0.5, thickness = 0.004, index = 2.5, wavelength = kTwoPi / kWavenumber;
  for (const double angle : {0.3, 0.8, 1.1}) {
    const double across = length * std::sin(angle), ahead = length * std::cos(angle);
    double low = 0.0, high = std::sin(angle) + 0.1;  // of the bent ray outside
    for (int step = 0; step < 200; ++step) {
      const double sine = 0.5 * (low + high), cosine = std::sqrt(1.0 - sine * sine);
      const double inside = sine / index,
                   found = (ahead - thickness) * sine / cosine + thickness * inside / std::sqrt(1.0 - inside * inside);
      (found < across ? low : high) = sine;
    }
    const double outside = std::sqrt(1.0 - low * low), within = std::sqrt(1.0 - low * low / (index * index));
    const double bent = (ahead - thickness) / outside + index * thickness / within;
    const double sine = std::sin(angle), cosine = std::cos(angle);
    const double straight = length + thickness * (std::sqrt(index * index - sine * sine) - cosine);
    const LayerStack slab(std::vector<Layer>{{thickness, index * index}}, kFrequency);
    const double offset = slab.offset(cosine);
    EXPECT_NEAR(offset, thickness * (sine - cosine * sine / std::sqrt(index * index - sine * sine)), 1e-12);
    const double later = detour(Vec3(offset, 0.0, 0.0), length, wavelength);
    EXPECT_NEAR(straight + later, bent, 0.1 * std::abs(straight - bent) + 1e-9) << angle;
  }
}

TEST(SheetModel, DelayIsThatOfTheSlowerWave) {
  const double index = 1.5;
  Material sheet;
  sheet.layers = {{0.01, index * index}};
  const SheetPassage passage = SheetModel(sheet, kFrequency, {kFrequency, kFrequency}).passage(1.0);
  // Of the direct wave (index - 1) d, turned by the bounces within: the slope of the phase of Airy's formula.
  const auto phase = [&](double frequency) {
    const double k = kTwoPi * frequency / kSpeedOfLight, face = (1.0 - index) / (1.0 + index);
    const Complex through = std::polar(1.0, -k * index * 0.01);
    return std::arg((1.0 - face * face) * through / (1.0 - face * face * through * through) * std::polar(1.0, k * 0.01));
  };
  const double step = 1e6, slope = (phase(kFrequency + step) - phase(kFrequency - step)) / (2.0 * step);
  EXPECT_NEAR(passage.te_delay, -slope * kSpeedOfLight / kTwoPi, kDifference);
  EXPECT_NEAR(passage.te_delay, 0.005, 0.002);
}

// By the slope of the phase of Airy's formula, whose wavenumber is moved here by the thickness.
TEST(SheetModel, EachModeHasItsOwnDelay) {
  const double cosine = 0.3, step = 1e-5;
  Material sheet;
  sheet.layers = {{0.003, 4.0}};
  const auto slope = [&](bool is_te) {
    const auto passed = [&](double factor) {
      const double thickness = 0.003 * factor;
      return airy({thickness, 4.0}, cosine, is_te).transmission * std::polar(1.0, kWavenumber * thickness * cosine);
    };
    return -std::arg(passed(1.0 + step) * std::conj(passed(1.0 - step))) / (2.0 * step * kWavenumber);
  };
  const SheetPassage passage = SheetModel(sheet, kFrequency, {kFrequency, kFrequency}).passage(cosine);
  EXPECT_NEAR(passage.te_delay, slope(true), kDifference);
  EXPECT_NEAR(passage.tm_delay, slope(false), kDifference);
  EXPECT_GT(std::abs(passage.te_delay - passage.tm_delay), 100.0 * kDifference);
}

// By the phase of Airy's formula, followed over the band in steps too small for half a turn. At the start alone the delays
// are 4 to 40 mm longer.
TEST(SheetModel, DelaysAreTheMeanOverAllTurnsOfTheBand) {
  const double start = 3e9, band = 2e9;
  const int num_steps = 4000;
  for (const Layer& slab : {Layer{0.2, Complex(3.91, -0.05)}, Layer{0.2, Complex(40.0, -0.5)}, Layer{0.02, 6.3}}) {
    Material wall;
    wall.layers = {slab};
    for (const double cosine : {1.0, 0.6, 0.2}) {
      const SheetPassage passage = SheetModel(wall, start, {start, start + band}).passage(cosine);
      for (const bool is_te : {true, false}) {
        double turned = 0.0;
        Complex before = 0.0;
        for (int step = 0; step <= num_steps; ++step) {
          const double scale = (start + band * step / num_steps) / kFrequency;  // of the wavenumber, moved to the thickness
          const Layer scaled{slab.thickness * scale, slab.permittivity};
          const Complex now =
              airy(scaled, cosine, is_te).transmission * std::polar(1.0, kWavenumber * scaled.thickness * cosine);
          if (step > 0) turned += std::arg(now * std::conj(before));
          before = now;
        }
        EXPECT_NEAR(is_te ? passage.te_delay : passage.tm_delay, -turned * kSpeedOfLight / (kTwoPi * band), kDifference)
            << slab.permittivity << " " << cosine << " " << is_te;
        // Steps of the chirps may go down from the frequency at which fields are told.
        const SheetPassage from_top = SheetModel(wall, start + band, {start, start + band}).passage(cosine);
        EXPECT_EQ(from_top.te_delay, passage.te_delay);
        EXPECT_EQ(from_top.tm_delay, passage.tm_delay);
      }
    }
  }
}

TEST(SheetModel, DelaysOfStacksAreTheMeanOverTheBandToo) {
  const double start = 3e9, band = 3e9;
  const int num_steps = 4000;
  Material wall;
  wall.layers = {{0.0125, Complex(2.7, -0.1)}, {0.075, 1.0}, {0.2, Complex(5.2, -0.1), 0.01}, {0.002, Complex(1.0), 1e3}};
  for (const double cosine : {1.0, 0.3}) {
    LayerTransmission before = LayerStack(wall.layers, start).over_free_space(cosine);
    double te = 0.0, tm = 0.0;
    for (int step = 1; step <= num_steps; ++step) {
      const LayerTransmission now = LayerStack(wall.layers, start + band * step / num_steps).over_free_space(cosine);
      te -= std::arg(now.te * std::conj(before.te));
      tm -= std::arg(now.tm * std::conj(before.tm));
      before = now;
    }
    const SheetPassage passage = SheetModel(wall, start, {start, start + band}).passage(cosine);
    EXPECT_NEAR(passage.te_delay, te * kSpeedOfLight / (kTwoPi * band), kDifference) << cosine;
    EXPECT_NEAR(passage.tm_delay, tm * kSpeedOfLight / (kTwoPi * band), kDifference) << cosine;
  }
}

// The group delay of a wave of both modes is the mean of their delays, each as strong as its power.
TEST(SheetModel, DelaysCountByThePowerThatPasses) {
  const SheetPassage passage{0.5, 1.0, 0.002, 0.006, 0.0};
  EXPECT_NEAR(sheet_factor(passage, 0.5).delay, (0.25 * 0.002 + 1.0 * 0.006) / 1.25, kRounding);
}

TEST(SheetTable, AgreesWithTheModelBetweenItsRows) {
  Material sheet;
  sheet.layers = {{0.0125, Complex(2.7, -0.1)}, {0.075, 1.0}, {0.0125, Complex(2.7, -0.1)}};  // the walls of a room
  const SheetModel model(sheet, kFrequency, {kFrequency, kFrequency + 1e9});
  const SheetTable table(model);
  double worst = 0.0;
  for (double cosine = 0.0; cosine <= 1.0; cosine += 0.000731) {
    const SheetPassage expected = model.passage(cosine), found = table.passage(cosine);
    worst = std::max({worst, std::abs(found.te - expected.te), std::abs(found.tm - expected.tm)});
  }
  EXPECT_LT(worst, kInterpolated);
  EXPECT_LT(std::abs(table.passage(1.0).te - model.passage(1.0).te), kRounding);
}

TEST(SheetModel, SharesOfModesFollowThePolarisation) {
  const Vec3 normal = Vec3::UnitX(), level = Vec3(0.8, 0.6, 0.0), steep = Vec3(0.8, 0.0, 0.6);
  EXPECT_NEAR(te_share(Vec3::UnitZ(), level, normal), 1.0, kRounding);
  EXPECT_NEAR(te_share(Vec3::UnitZ(), steep, normal), 0.0, kRounding);
  EXPECT_NEAR(te_share(Vec3(0.0, 1.0, 1.0), Vec3(0.8, 0.36, 0.48), normal),
              te_share(Vec3(0.0, -1.0, -1.0), Vec3(0.8, 0.36, 0.48), normal), kRounding);
  // Malus's law; what lies along the direction does not count, and a field all along it has no mode.
  const Vec3 te = steep.cross(normal).normalized(), tm = te.cross(steep);
  EXPECT_NEAR(te_share(std::cos(0.7) * te + std::sin(0.7) * tm + 2.0 * steep, steep, normal), std::pow(std::cos(0.7), 2),
              kRounding);
  EXPECT_EQ(te_share(steep + 1e-8 * tm, steep, normal), 1.0);
  EXPECT_EQ(te_share(Vec3::UnitZ(), normal, normal), 1.0);
  EXPECT_EQ(te_share(Vec3::UnitZ(), Vec3(1.0, 0.0, 1e-10), normal), 1.0);
}

TEST(SurfaceModel, SheetsReflectAsTheirLayersFromEitherSide) {
  Material sheet;
  sheet.layers = kStack;
  const SurfaceModel front(sheet, kFrequency), back(sheet, kFrequency, SheetSide::kBack);
  std::vector<Layer> reversed = kStack;
  std::reverse(reversed.begin(), reversed.end());
  expect_near(front.respond(0.6, PolarizationMode::kTe).gamma, LayerStack(kStack, kFrequency).reflection(0.6).te);
  EXPECT_NEAR(front.respond(0.6, PolarizationMode::kTe).facet, std::abs(by_matrices(kStack, 1.0, true).reflection),
              kRounding);
  expect_near(back.respond(0.6, PolarizationMode::kTm).gamma, LayerStack(reversed, kFrequency).reflection(0.6).tm);
}

TEST(Material, LayersExcludeOtherKindsAndMirrors) {
  Material sheet;
  sheet.layers = kPane;
  sheet.validate();
  sheet.mirror = true;
  EXPECT_THROW(sheet.validate(), std::invalid_argument);
  sheet.mirror = false;
  sheet.conductor = true;
  EXPECT_THROW(sheet.validate(), std::invalid_argument);
  sheet.conductor = false;
  sheet.layers[0].thickness = 0.0;
  EXPECT_THROW(sheet.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_layers
