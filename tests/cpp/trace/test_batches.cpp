// Batches: independent lattices that share the rays of each stratum.
#include <gtest/gtest.h>

#include <algorithm>

#include "cpp/support/scenes.h"
#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/launch/launch.h"
#include "echopath/trace/launch/launch_directions.h"
#include "echopath/trace/launch/launch_lattice.h"

namespace echopath::test_batches {
namespace {

using namespace testing;

constexpr int kBatches = 8;
constexpr double kMoments = 0.01;  // of 1/2: what the rim of a lattice of an eighth of the points adds
constexpr double kSphere = 5e-3;   // relative: each batch covers the sphere to some of its points

std::vector<Eigen::Vector2d> some_shifts() {
  std::vector<Eigen::Vector2d> shifts;
  for (int i = 0; i < kBatches; ++i) shifts.emplace_back(0.113 * i, std::fmod(0.377 * i + 0.05, 1.0));
  return shifts;
}

TEST(Batches, OfALatticeAddUpAndAreEven) {
  for (const int64_t count : {0, 8, 100, 8000, 100003}) {
    const LaunchLattice lattice(LaunchDomain{}, count, some_shifts());
    ASSERT_EQ(lattice.size(), count);
    if (count < 8000) continue;
    std::vector<double> size(kBatches), second_moment(kBatches);
    int last = 0;
    for (int64_t i = 0; i < count; ++i) {
      const int batch = lattice.batch_of(i);
      ASSERT_TRUE(batch == last || batch == last + 1);  // one after the other
      last = batch;
      size[static_cast<size_t>(batch)] += 1.0;
      second_moment[static_cast<size_t>(batch)] += lattice.point(i).squaredNorm();
    }
    const double share = static_cast<double>(count) / kBatches;
    for (int b = 0; b < kBatches; ++b) {
      EXPECT_NEAR(size[static_cast<size_t>(b)] / share, 1.0, 2.0 / std::sqrt(share)) << b;
      // The mean of r^2 over the disc is 1/2; of a random set of this size it errs by 1 %.
      EXPECT_NEAR(second_moment[static_cast<size_t>(b)] * lattice.cell_area() * kBatches / kPi, 0.5, kMoments) << b;
    }
  }
}

TEST(Batches, HaveLatticesOfTheirOwn) {
  const LaunchLattice lattice(LaunchDomain{}, 8000, some_shifts());
  std::vector<Eigen::Vector2d> points;
  for (int64_t i = 0; i < lattice.size(); ++i) points.push_back(lattice.point(i));
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  for (size_t i = 1; i < points.size(); ++i) ASSERT_GT((points[i] - points[i - 1]).norm(), 1e-9);
}

Scene rough_ball_and_wall() {
  Scene scene;
  Surface ball = ellipsoid({6, 0.5, 0.2}, {0.4, 0.3, 0.5}, 3);
  Material rough;
  rough.permittivity = std::complex<double>(4.0, -0.2);
  rough.scattering = 0.7;
  add_mesh(scene, "ball", std::move(ball.vertices), std::move(ball.triangles), share(rough));
  add_rectangle(scene, "wall", {-5, 2, -2}, {30, 0, 0}, {0, 0, 6}, share(Material::metal(true)));
  return scene;
}

// Each batch alone stands for all directions of its stratum: its rays, over their density, are the solid angle.
TEST(Batches, EachCoversItsStratum) {
  const Scene scene = rough_ball_and_wall();
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  LaunchSettings settings;
  settings.num_rays = 100000;
  settings.batches = kBatches;
  const std::vector<Mirror> mirrors = find_mirrors(scene, geometry);
  const MirrorFrusta frusta = FrustumFinder(mirrors, &geometry).find(settings.transmitter, {});
  settings.frusta = frusta.frusta;
  const LaunchPlan plan = plan_launch(scene, geometry, mirrors, settings);
  ASSERT_EQ(plan.first_ray.back(), settings.num_rays);
  std::vector<std::vector<double>> rays(plan.strata.size(), std::vector<double>(kBatches));
  for (int64_t ray = 0; ray < settings.num_rays; ++ray) {
    const int stratum = plan.stratum_of(ray);
    rays[static_cast<size_t>(stratum)][static_cast<size_t>(plan.batch_of(stratum, ray))] += 1.0;
  }
  for (size_t k = 0; k < plan.strata.size(); ++k) {
    for (const double count : rays[k]) {
      EXPECT_NEAR(count / plan.lattice_density(static_cast<int>(k)) / plan.strata[k].solid_angle(), 1.0, kSphere)
          << plan.strata[k].name;
    }
  }
}

TEST(Batches, MarkPathsAndLeaveImagesOut) {
  TraceSettings settings = with_rays(4000);
  settings.batches = 5;
  const Paths paths = trace(rough_ball_and_wall(), plain_radar({0, 0, 0}, {0, 0.1, 0}), settings);
  EXPECT_EQ(paths.frame.batches, 5);
  EXPECT_NO_THROW(paths.validate());
  std::vector<int64_t> count(256);
  for (int64_t i = 0; i < paths.num_paths(); ++i) {
    const auto p = static_cast<size_t>(i);
    ++count[paths.batch[p]];
    EXPECT_EQ(paths.batch[p] == kNoBatch, paths.stratum[p] == kNoStratum);
  }
  EXPECT_EQ(count[kNoBatch], 1);  // the echo of the wall
  for (size_t b = 0; b < 5; ++b) EXPECT_GT(count[b], 100) << b;
  for (size_t b = 5; b < 255; ++b) EXPECT_EQ(count[b], 0) << b;
}

TEST(Batches, BadNumbersAreNamed) {
  for (const int batches : {0, 65}) {
    TraceSettings settings;
    settings.batches = batches;
    EXPECT_THROW(trace(Scene(), plain_radar(Vec3::Zero(), Vec3::Zero()), settings), std::invalid_argument);
  }
}

}  // namespace
}  // namespace echopath::test_batches
