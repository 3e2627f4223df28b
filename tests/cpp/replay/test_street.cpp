// A rough body between two mirror walls over a mirror floor: levels of the ghost families against independent quadrature.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support/scenes.h"

namespace echopath {
namespace {

using namespace testing;

constexpr double kFamilyTolerance = 0.3;  // dB, Monte-Carlo error of 2e5 rays included

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
  const std::vector<std::pair<Vec3, Vec3>> parts = {
      {{0, 0, 1.15}, {.12, .2, .32}},   {{0, 0, 1.66}, {.10, .08, .12}},  {{0, .10, .45}, {.08, .08, .45}},
      {{0, -.10, .45}, {.08, .08, .45}}, {{0, .27, 1.15}, {.05, .05, .33}}, {{0, -.27, 1.15}, {.05, .05, .33}}};
  for (size_t i = 0; i < parts.size(); ++i) {
    Surface surface = ellipsoid(foot + parts[i].first, parts[i].second, 4);
    Node node;
    node.name = "part" + std::to_string(i);
    node.parent = parent;
    node.mesh = std::make_shared<Mesh>(std::move(surface.vertices), std::move(surface.triangles));
    node.material = lambert(0.34);
    scene.add(node);
  }
  add_rectangle(scene, "left", {-20, 3, 0}, {60, 0, 0}, {0, 0, 12}, rough_mirror(0.2));
  add_rectangle(scene, "right", {-20, -3, 0}, {60, 0, 0}, {0, 0, 12}, rough_mirror(0.2));
  add_rectangle(scene, "ground", {-20, -20, 0}, {60, 0, 0}, {0, 40, 0}, rough_mirror(0.1));
  return scene;
}

using Key = std::tuple<uint32_t, uint32_t, float, float>;  // the body hit

// Powers of families "mirrors of the transmit leg and of the receive leg" without order: fields of one hit add up.
std::map<std::multiset<std::string>, double> family_powers(const Paths& paths) {
  const Replayed replay = replayed(paths);
  std::map<std::pair<std::multiset<std::string>, Key>, std::complex<double>> fields;
  for (int64_t i = 0; i < paths.num_paths(); ++i) {
    const Hit* hits = paths.hits_of(i);
    const int count = paths.num_bounces[static_cast<size_t>(i)];
    const Hit* body_hit = nullptr;
    int num_body_hits = 0, body_at = 0;
    std::multiset<std::string> mirrors;
    for (int k = 0; k < count; ++k) {
      const std::string& name = paths.scene->node_of(hits[k].mesh_id).name;
      if (name.starts_with("body")) {
        body_hit = hits + k;
        body_at = k;
        ++num_body_hits;
      } else {
        mirrors.insert(name);
      }
    }
    const bool one_mirror_a_leg = num_body_hits == 1 && body_at <= 1 && count - body_at <= 2;
    if (!one_mirror_a_leg || paths.diffuse[static_cast<size_t>(i)] != uint64_t{1} << body_at) continue;
    const Key key{body_hit->mesh_id, body_hit->triangle_id, body_hit->u, body_hit->v};
    // Both orders have the same length between co-located antennas, so the phase of the length drops out.
    fields[{mirrors, key}] += replay.amplitudes[static_cast<size_t>(i)];
  }
  std::map<std::multiset<std::string>, double> powers;
  for (const auto& [family, field] : fields) powers[family.first] += std::norm(field);
  return powers;
}

TEST(Street, GhostFamiliesHaveTheirLevels) {
  TraceSettings settings;
  settings.num_rays = 200000;
  const Paths paths = trace(street(), plain_radar({0, 0, 1}, {0, 0, 1}), settings);
  auto powers = family_powers(paths);
  const double direct = powers[{}];
  const auto level = [&](const std::multiset<std::string>& family) { return decibel(powers[family] / direct); };
  EXPECT_NEAR(level({"left"}), -0.85, kFamilyTolerance);
  EXPECT_NEAR(level({"right"}), -1.74, kFamilyTolerance);
  EXPECT_NEAR(level({"ground"}), -2.90, kFamilyTolerance);
  EXPECT_NEAR(level({"left", "left"}), -12.66, kFamilyTolerance);
  EXPECT_NEAR(level({"ground", "ground"}), -16.65, kFamilyTolerance);
  double total = 0.0;
  for (const auto& [family, power] : powers) total += power;
  EXPECT_NEAR(decibel(total / direct), 5.36, kFamilyTolerance);
}

}  // namespace
}  // namespace echopath
