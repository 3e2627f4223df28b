// Rays side by side: what packets find is what each ray finds by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cpp/support/scenes.h"
#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/trace.h"

namespace echopath::test_packets {
namespace {

using namespace testing;

constexpr double kSingle = 4e-7;  // relative, of weights that were rounded to single precision after different operations

Material rough(double scattering) {
  Material material;
  material.reflectivity = 0.6;
  material.scattering = scattering;
  return material;
}

// Every kind of surface: smooth, rough by a share and by height, dielectric, conducting, perfectly diffuse, and absorbing.
Scene every_surface() {
  Scene scene;
  Material dielectric, uneven = Material::metal(), black;
  dielectric.permittivity = std::complex<double>(4.0, -0.2);
  dielectric.scattering = 0.4;
  uneven.roughness_height = 2e-4;
  black.reflectivity = 0.0;
  Surface ball = ellipsoid({6, 0.5, 0.2}, {0.8, 0.6, 1.0}, 3), egg = ellipsoid({6, -2.5, 0.2}, {0.8, 0.8, 0.8}, 3);
  Node smooth = node_with("ball", std::move(ball), share(rough(0.8)), true);
  scene.add(smooth);
  add_mesh(scene, "egg", std::move(egg.vertices), std::move(egg.triangles), share(uneven));
  add_rectangle(scene, "floor", {5, -3, -1.1}, {4, 0, 0}, {0, 5, 0}, share(dielectric));
  add_rectangle(scene, "plate", {8, -2, -1}, {0, 1, 0}, {0, 0, 2}, share(dielectric));
  add_rectangle(scene, "side", {5, 2.5, -1}, {2, 0, 0}, {0, 0, 2}, share(rough(1.0)));
  add_rectangle(scene, "metal", {9, 0.5, -1}, {0, 2, 0}, {0, 0, 2}, share(Material::metal()));
  add_rectangle(scene, "screen", {7, -0.9, -1}, {0, 0.6, 0}, {0, 0, 0.6}, share(black));
  add_rectangle(scene, "far end", {-3, 2, -1}, {0, 0.1, 0}, {0, 0, 0.1}, share(Material::metal()));
  return scene;
}

// Of the paths that touch nothing of the mesh `without`: hits and weights, in order.
struct Row {
  std::vector<Hit> hits;
  uint64_t diffuse;
  std::complex<float> weight;
};

std::vector<Row> rows_of(const Paths& paths, uint32_t without) {
  std::vector<Row> rows;
  for (int64_t i = 0; i < paths.num_paths(); ++i) {
    const auto p = static_cast<size_t>(i);
    const Hit* first = paths.hits_of(i);
    const Hit* last = first + paths.num_bounces[p];
    if (std::any_of(first, last, [&](const Hit& hit) { return hit.mesh_id == without; })) continue;
    rows.push_back({{first, last}, paths.diffuse[p], paths.weight[p]});
  }
  return rows;
}

bool same_hits(const Row& a, const Row& b) {
  const auto is_same = [](const Hit& x, const Hit& y) {
    return x.mesh_id == y.mesh_id && x.triangle_id == y.triangle_id && x.u == y.u && x.v == y.v;
  };
  return a.diffuse == b.diffuse && std::equal(a.hits.begin(), a.hits.end(), b.hits.begin(), b.hits.end(), is_same);
}

// A small flagged mirror that reflects the radar past everything, but has every hit looked at for legs by itself.
TEST(Trace, PacketsWriteDownWhatRaysDoOneByOne) {
  const Radar radar = plain_radar({0, 0, 0}, {0, 0.1, 0.3});
  TraceSettings settings = with_rays(20000);
  settings.batches = 3;
  const Scene alone = every_surface();
  Scene mirrored = every_surface();
  const Vec3 normal(0.82, 0.57, 1.0), across = normal.cross(Vec3::UnitZ()), up = normal.cross(across);  // it looks upward
  add_rectangle(mirrored, "mirror", {-2.9, -2.0, 0.0}, 0.01 * across, 0.01 * up, share(Material::metal(true)));
  const auto mirror = static_cast<uint32_t>(mirrored.meshes().size() - 1);
  const Paths by_one = trace(mirrored, radar, settings);
  settings.guide = guide_like(by_one.frame.strata);  // the same rays
  const std::vector<Row> together = rows_of(trace(alone, radar, settings), mirror), one_by_one = rows_of(by_one, mirror);
  ASSERT_EQ(together.size(), one_by_one.size());
  int num_coherent = 0, num_diffuse = 0, num_long = 0;
  for (size_t i = 0; i < together.size(); ++i) {
    ASSERT_TRUE(same_hits(together[i], one_by_one[i])) << i;
    ASSERT_LE(std::abs(together[i].weight - one_by_one[i].weight), kSingle * std::abs(one_by_one[i].weight)) << i;
    num_long += together[i].hits.size() > 1;
    (together[i].diffuse == 0 ? num_coherent : num_diffuse) += 1;
  }
  EXPECT_GT(num_coherent, 2000);
  EXPECT_GT(num_diffuse, 2000);
  EXPECT_GT(num_long, 200);
}

// What lies within a millimetre of an antenna makes no path, whichever way it is written down.
TEST(Trace, PacketsDropWhatLiesAtAnAntenna) {
  Scene scene;
  add_rectangle(scene, "speck", {6, -1e-3, -1e-3}, {0, 2e-3, 0}, {0, 0, 2e-3}, share(rough(0.5)));
  TraceSettings settings = with_rays(4000, 1);
  const Vec3 receiver(6 - 5e-4, 0, 0);
  const Paths paths = trace(scene, plain_radar(Vec3::Zero(), receiver), settings);
  const double half = std::sqrt(1e-6 - 25e-8);  // m: radius on the speck of what is nearer than 1 mm
  int64_t num_near = 0;
  for (int64_t i = 0; i < paths.num_paths(); ++i) {
    const Hit& hit = *paths.hits_of(i);
    const Mesh& mesh = *paths.scene->node_of(hit.mesh_id).mesh;
    const Triangle& corners = mesh.triangles()[hit.triangle_id];
    const Vec3 a = mesh.vertices()[corners[0]], b = mesh.vertices()[corners[1]], c = mesh.vertices()[corners[2]];
    const Vec3 point = a + double{hit.u} * (b - a) + double{hit.v} * (c - a);
    num_near += std::hypot(point.y(), point.z()) < half - 1e-6 ? 1 : 0;
  }
  EXPECT_EQ(num_near, 0);
  const TraceStatistics& statistics = paths.frame.statistics;
  EXPECT_GT(statistics.num_near_antenna, 500);
  EXPECT_LE(statistics.num_queries, statistics.num_rays + statistics.num_hits);  // none goes on behind its last bounce
  EXPECT_GT(paths.num_paths(), 500);
}

}  // namespace
}  // namespace echopath::test_packets
