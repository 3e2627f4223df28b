// A rough body between two mirror walls over a mirror floor: levels of the ghost families against independent quadrature.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "cpp/support/scenes.h"

namespace echopath::test_street {
namespace {

using namespace testing;

constexpr double kFamilyTolerance = 0.1;  // dB; the weakest family errs by 0.05 at 4e4 rays
// dB; over a wall and a floor true fields turn a little, which the reference has not
constexpr double kTurnTolerance = 0.2;

MaterialPtr rough_mirror(double diffuse_share) {
  Material material;
  material.permittivity = std::complex<double>(5.0, -0.3);
  material.scattering = std::sqrt(diffuse_share);
  material.mirror = true;
  return share(material);
}

Scene street() {
  Scene scene;
  Node body;
  body.name = "body";
  const int parent = scene.add(body);
  const Vec3 foot(10.0, 0.5, 0.0);
  const std::vector<std::pair<Vec3, Vec3>> parts = {{{0, 0, 1.15}, {.12, .2, .32}},    {{0, 0, 1.66}, {.10, .08, .12}},
                                                    {{0, .10, .45}, {.08, .08, .45}},  {{0, -.10, .45}, {.08, .08, .45}},
                                                    {{0, .27, 1.15}, {.05, .05, .33}}, {{0, -.27, 1.15}, {.05, .05, .33}}};
  for (size_t i = 0; i < parts.size(); ++i) {
    Surface surface = ellipsoid(foot + parts[i].first, parts[i].second, 4);
    Node node = node_with("part" + std::to_string(i), std::move(surface), lambert(0.34));
    node.parent = parent;
    scene.add(node);
  }
  add_rectangle(scene, "left", {-20, 3, 0}, {60, 0, 0}, {0, 0, 12}, rough_mirror(0.2));
  add_rectangle(scene, "right", {-20, -3, 0}, {60, 0, 0}, {0, 0, 12}, rough_mirror(0.2));
  add_rectangle(scene, "ground", {-20, -20, 0}, {60, 0, 0}, {0, 40, 0}, rough_mirror(0.1));
  return scene;
}

using Key = std::tuple<uint32_t, uint32_t, float, float>;  // the body hit

using Families = std::map<std::multiset<std::string>, double>;

// Powers of families "mirrors of the transmit leg and of the receive leg" without order: fields of one hit add up. Over at
// most `max_leg_mirrors` mirrors a leg.
Families family_powers(const Paths& paths, int max_leg_mirrors) {
  const Replayed replay = replayed(paths);
  const double wavenumber = kTwoPi * paths.radar.waveform.start_frequency / kSpeedOfLight;
  constexpr int kMostHits = 4;
  using Mirrors = std::array<uint32_t, kMostHits>;  // mesh IDs plus 1, descending, then 0
  std::map<std::pair<Mirrors, Key>, std::complex<double>> fields;
  for (int64_t i = 0; i < paths.num_paths(); ++i) {
    const auto p = static_cast<size_t>(i);
    const Hit* hits = paths.hits_of(i);
    const int count = paths.num_bounces[p];
    const Hit* body_hit = nullptr;
    int num_body_hits = 0, body_at = 0;
    Mirrors mirrors{};
    for (int k = 0; k < count; ++k) {
      if (!paths.scene->node_of(hits[k].mesh_id).material->mirror) {
        body_hit = hits + k;
        body_at = k;
        ++num_body_hits;
      } else {
        mirrors.at(static_cast<size_t>(k)) = hits[k].mesh_id + 1;
      }
    }
    const bool is_family = num_body_hits == 1 && std::max(body_at, count - 1 - body_at) <= max_leg_mirrors;
    if (!is_family || paths.diffuse[p] != uint64_t{1} << body_at) continue;
    std::sort(mirrors.rbegin(), mirrors.rend());
    const Key key{body_hit->mesh_id, body_hit->triangle_id, body_hit->u, body_hit->v};
    fields[{mirrors, key}] += replay.amplitudes[p] * std::polar(1.0, -std::fmod(wavenumber * replay.lengths[p], kTwoPi));
  }
  Families powers;
  for (const auto& [family, field] : fields) {
    std::multiset<std::string> names;
    for (const uint32_t mirror : family.first) {
      if (mirror > 0) names.insert(paths.scene->node_of(mirror - 1).name);
    }
    powers[names] += std::norm(field);
  }
  return powers;
}

double total(const Families& powers) {
  double sum = 0.0;
  for (const auto& [family, power] : powers) sum += power;
  return sum;
}

// Vertical antennas: TE at the walls, TM at the floor.
class Street : public ::testing::TestWithParam<PolarizationModel> {
 protected:
  static void TearDownTestSuite() { traced_.clear(); }

  static const Paths& paths() {
    const auto [entry, is_new] = traced_.try_emplace(GetParam());
    if (is_new) {
      TraceSettings settings = with_rays(40000);
      settings.polarization = GetParam();
      entry->second = trace(street(), plain_radar({0, 0, 1}, {0, 0, 1}), settings);
    }
    return entry->second;
  }
  // In dB over the direct echo.
  static double level(const Families& powers, const std::multiset<std::string>& family) {
    return decibel(powers.at(family) / powers.at({}));
  }

 private:
  static std::map<PolarizationModel, Paths> traced_;
};
std::map<PolarizationModel, Paths> Street::traced_;

INSTANTIATE_TEST_SUITE_P(Models, Street, ::testing::Values(PolarizationModel::kScalar, PolarizationModel::kJones));

// The reference, its total too, knows of one mirror a leg.
TEST_P(Street, GhostFamiliesHaveTheirLevels) {
  const Families powers = family_powers(paths(), 1);
  EXPECT_NEAR(level(powers, {"left"}), -0.85, kFamilyTolerance);
  EXPECT_NEAR(level(powers, {"right"}), -1.74, kFamilyTolerance);
  EXPECT_NEAR(level(powers, {"ground"}), -2.90, kFamilyTolerance);
  EXPECT_NEAR(level(powers, {"left", "left"}), -12.66, kFamilyTolerance);
  EXPECT_NEAR(level(powers, {"ground", "ground"}), -16.65, kFamilyTolerance);
  EXPECT_NEAR(decibel(total(powers) / powers.at({})), 5.36, kFamilyTolerance);
}

// Quadrature over the ellipsoids (2e4 points each) with image theory over all sequences of up to two mirrors a leg and four
// hits in all: the two mirrors of a family lie on one leg or on both.
TEST_P(Street, FamiliesOverTwoMirrorsALegHaveTheirLevels) {
  const Families powers = family_powers(paths(), 2);
  const double tolerance = GetParam() == PolarizationModel::kScalar ? kFamilyTolerance : kTurnTolerance;
  EXPECT_NEAR(level(powers, {"left", "ground"}), -6.20, tolerance);
  EXPECT_NEAR(level(powers, {"right", "ground"}), -6.87, tolerance);
  EXPECT_NEAR(level(powers, {"left", "right"}), -7.38, tolerance);
  EXPECT_NEAR(level(powers, {"left", "right", "ground"}), -13.20, tolerance);
  EXPECT_NEAR(level(powers, {"left", "left", "ground"}), -14.38, tolerance);
  EXPECT_NEAR(level(powers, {"left", "ground", "ground"}), -16.53, tolerance);
  EXPECT_NEAR(level(powers, {"left", "right", "right"}), -19.08, tolerance);
  EXPECT_NEAR(decibel(total(powers) / powers.at({})), 5.94, tolerance);
}

}  // namespace
}  // namespace echopath::test_street
