// Which launch cells lie at the rim of what they see.
#include "echopath/power/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "echopath/base/parallel.h"
#include "echopath/power/received_power.h"
#include "support/scenes.h"

namespace echopath {
namespace {

using namespace testing;

constexpr double kAtRim = 0.3, kInside = 1.6;  // cells from a line that cuts the surface: surely at it, surely not
constexpr double kDistance = 10.0;             // m
constexpr double kOfRidge =
    8e-4;  // of the unfiltered power, that a limb's cells may hold; 1.8e-3 if all along its ridge counted

Paths shot(const Scene& scene, int64_t num_rays = 6000, int batches = 1, const Vec3& receiver = Vec3::Zero()) {
  TraceSettings settings;
  settings.num_rays = num_rays;
  settings.max_bounces = 1;
  settings.batches = batches;
  return trace(scene, plain_radar(Vec3::Zero(), receiver), settings);
}

std::vector<int64_t> all_of(const Paths& paths) {
  std::vector<int64_t> members(static_cast<size_t>(paths.num_paths()));
  std::iota(members.begin(), members.end(), int64_t{0});
  return members;
}

Vec3 point_of(const Paths& paths, int64_t path) {
  const Hit& hit = *paths.hits_of(path);
  const auto [a, b, c] = PosedScene(*paths.scene, paths.frame.trace_time).world_triangle(hit.mesh_id, hit.triangle_id);
  return a + hit.u * (b - a) + hit.v * (c - a);
}

// m, side of a launch cell across the line of sight at the distance of the surfaces here.
double cell_at(const Paths& paths, int64_t path) {
  return kDistance / std::sqrt(paths.frame.lattice_density(paths.stratum[static_cast<size_t>(path)]));
}

// distance: m, of a point to the nearest line that cuts the surface, as seen from the radar.
template <class Distance>
void expect_rim(const Paths& paths, const Distance& distance) {
  const std::vector<int64_t> members = all_of(paths);
  const std::vector<uint8_t> at_rim = cells_at_rim(paths, members);
  ASSERT_EQ(at_rim.size(), members.size());
  int num_at_rim = 0, num_inside = 0;
  for (const int64_t path : members) {
    const double away = distance(point_of(paths, path)) / cell_at(paths, path);
    if (away < kAtRim) {
      EXPECT_TRUE(at_rim[static_cast<size_t>(path)]) << away;
    }
    if (away > kInside) {
      EXPECT_FALSE(at_rim[static_cast<size_t>(path)]) << away;
    }
    num_at_rim += away < kAtRim;
    num_inside += away > kInside;
  }
  EXPECT_GT(num_at_rim, 10);
  EXPECT_GT(num_inside, 100);
}

double to_rim_of_square(const Vec3& point) { return 0.5 - std::max(std::abs(point.y()), std::abs(point.z())); }

TEST(Outline, OfAPlateIsItsRimInEachBatch) {
  Scene scene;
  add_rectangle(scene, "plate", {kDistance, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}, share(Material::metal()));
  for (const int batches : {1, 4}) expect_rim(shot(scene, 6000 * batches, batches), to_rim_of_square);
}

TEST(Outline, HasTheCreasesWithinAMesh) {
  Scene scene;
  const double back = kDistance + 0.4;
  add_mesh(scene, "roof",
           {{back, -0.5, -0.5},
            {kDistance, 0, -0.5},
            {back, 0.5, -0.5},
            {back, -0.5, 0.5},
            {kDistance, 0, 0.5},
            {back, 0.5, 0.5}},
           {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}, share(Material::metal()));
  expect_rim(shot(scene), [](const Vec3& point) {
    const double scale = kDistance / point.x();  // as seen from the radar
    const double rim = scale * std::min(0.5 - std::abs(point.y()), 0.5 - std::abs(point.z()));
    return std::min(rim, scale * std::abs(point.y()));
  });
}

TEST(Outline, HasTheStepsWithinAMesh) {
  Scene scene;
  const double back = kDistance + 0.3;
  add_mesh(scene, "steps",
           {{kDistance, -0.5, -0.5},
            {kDistance, 0, -0.5},
            {kDistance, 0, 0.5},
            {kDistance, -0.5, 0.5},
            {back, -0.5, -0.5},
            {back, 0.5, -0.5},
            {back, 0.5, 0.5},
            {back, -0.5, 0.5}},
           {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, share(Material::metal()));
  expect_rim(shot(scene), [](const Vec3& point) {
    const double scale = kDistance / point.x();
    const double rim = std::min(scale * (0.5 - std::abs(point.z())), scale * (0.5 - std::abs(point.y())));
    return std::min(std::abs(scale * point.y()), rim);
  });
}

// An ellipsoid across the line of sight goes on smoothly from facet to facet: only its silhouette is a rim.
TEST(Outline, OfASmoothBodyHasNoneOfItsFacets) {
  Scene scene;
  const Surface surface = ellipsoid({kDistance, 0, 0}, {0.3, 0.5, 0.5}, 4);
  Node body;
  body.name = "body";
  body.mesh = std::make_shared<Mesh>(surface.vertices, surface.triangles);
  body.material = share(Material::metal());
  body.smooth = true;
  scene.add(body);
  const Paths paths = shot(scene);
  const std::vector<int64_t> members = all_of(paths);
  const std::vector<uint8_t> at_rim = cells_at_rim(paths, members);
  int num_inside = 0;
  for (const int64_t path : members) {
    const Vec3 point = point_of(paths, path);
    if (std::hypot(point.y(), point.z()) > 0.4) continue;
    EXPECT_FALSE(at_rim[static_cast<size_t>(path)]);
    ++num_inside;
  }
  EXPECT_GT(num_inside, 100);
}

// Along the ridge of a limb that points past the radar each cell is stationary across, but only the ends radiate.
TEST(Outline, EndsOfALimbAloneMayHideEdges) {
  Scene scene;
  const Surface surface = ellipsoid(Vec3::Zero(), {0.5, 0.06, 0.06}, 4);
  Node limb;
  limb.name = "limb";
  limb.mesh = std::make_shared<Mesh>(surface.vertices, surface.triangles);
  limb.material = share(Material::metal());
  limb.smooth = true;
  limb.placement = Transform(Eigen::Translation3d(kDistance, 0, 0) * Eigen::AngleAxisd(0.25 * kPi, Vec3::UnitY()));
  scene.add(limb);
  const ReceivedPower few = received_power(shot(scene, 3000)), many = received_power(shot(scene, 100000));
  EXPECT_LT(few.between_rays, kOfRidge * few.unfiltered);
  EXPECT_GT(few.high, many.power);
}

TEST(Outline, DoesNotDependOnTheNumberOfThreads) {
  Scene scene;
  add_rectangle(scene, "plate", {kDistance, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}, share(Material::metal()));
  const Paths paths = shot(scene);
  std::vector<std::vector<uint8_t>> found;
  for (const int threads : {1, 2}) {
    set_num_threads(threads);
    found.push_back(cells_at_rim(paths, all_of(paths)));
  }
  set_num_threads(0);
  EXPECT_EQ(found[0], found[1]);
  EXPECT_TRUE(cells_at_rim(paths, {}).empty());
}

}  // namespace
}  // namespace echopath
