// The probabilities of a ray's ways on: shares of power, and a roulette that lets no lobe gain weight.
#include <gtest/gtest.h>

#include <complex>

#include "echopath/trace/scatter/lobe_probabilities.h"

namespace echopath::test_lobe_probabilities {
namespace {

constexpr double kFrequency = 77e9, kCosine = 0.8;
constexpr double kRounding = 1e-15;

Material rough_concrete() {
  Material material;
  material.permittivity = {5.0, -0.3};
  material.scattering = 0.6;
  return material;
}

TEST(LobeProbabilities, AreTheSharesOfPower) {
  const Material material = rough_concrete();
  const SurfaceModel model(material, kFrequency);
  const LobeProbabilities found = lobe_probabilities(model, model.respond(kCosine, PolarizationMode::kTe), 0.0);
  EXPECT_NEAR(found.diffuse, 0.36, kRounding);
  EXPECT_NEAR(found.specular, 0.64, kRounding);
}

TEST(LobeProbabilities, AreThoseAskedForWhereASurfaceDoesBoth) {
  Material material = rough_concrete();
  const SurfaceModel both(material, kFrequency);
  const SurfaceResponse response = both.respond(kCosine, PolarizationMode::kTe);
  EXPECT_EQ(lobe_probabilities(both, response, 0.9).specular, 0.9);
  EXPECT_NEAR(lobe_probabilities(both, response, 0.9).diffuse, 0.1, kRounding);
  material.scattering = 0.0;
  const SurfaceModel smooth(material, kFrequency);
  EXPECT_EQ(lobe_probabilities(smooth, smooth.respond(kCosine, PolarizationMode::kTe), 0.9).specular, 1.0);
}

// The balance weight over legs counts on it.
TEST(LobeProbabilities, FlaggedMirrorsKeepTheirShares) {
  Material material = rough_concrete();
  material.mirror = true;
  const SurfaceModel model(material, kFrequency);
  const LobeProbabilities found = lobe_probabilities(model, model.respond(kCosine, PolarizationMode::kTe), 0.9);
  EXPECT_NEAR(found.specular, 0.64, kRounding);
}

// A ray becomes four at most: one that is mirrored at each of its first three hits, and one that each of these scatters.
TEST(LobeProbabilities, BothWaysAreGoneAtTheFirstHitsAlone) {
  Material material = rough_concrete();
  const SurfaceModel model(material, kFrequency);
  const LobeProbabilities both{0.64, 0.36};
  for (const int depth : {1, 2, 3}) EXPECT_TRUE(goes_both_ways(model, both, 0.0, depth));
  EXPECT_FALSE(goes_both_ways(model, both, 0.0, 4));
  EXPECT_FALSE(goes_both_ways(model, both, 0.9, 1));         // asked for
  EXPECT_FALSE(goes_both_ways(model, {1.0, 0.0}, 0.0, 1));   // smooth
  EXPECT_FALSE(goes_both_ways(model, {1e-9, 1.0}, 0.0, 1));  // mirrors next to nothing
  material.mirror = true;
  EXPECT_FALSE(goes_both_ways(SurfaceModel(material, kFrequency), both, 0.0, 1));
}

TEST(SurvivalProbability, LetsNoLobeGainWeight) {
  const Material material = rough_concrete();
  const SurfaceModel model(material, kFrequency);
  for (const double cosine : {0.05, 0.4, 0.8, 1.0}) {
    for (const PolarizationMode mode : {PolarizationMode::kTe, PolarizationMode::kTm}) {
      const SurfaceResponse response = model.respond(cosine, mode);
      const double survival = survival_probability(response, kRouletteBounce);
      EXPECT_EQ(survival_probability(response, kRouletteBounce - 1), 1.0);
      EXPECT_LE(std::norm(response.gamma), survival);
      EXPECT_LE(response.facet * response.facet, survival);
      EXPECT_LE(survival, 1.0);
    }
  }
}

}  // namespace
}  // namespace echopath::test_lobe_probabilities
