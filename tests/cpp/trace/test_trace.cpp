// The record of a trace: determinism, shapes, offsets of the world, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "cpp/support/expect_error.h"
#include "cpp/support/scenes.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/launch/launch.h"
#include "echopath/trace/launch/launch_directions.h"
#include "echopath/trace/launch/launch_lattice.h"

namespace echopath::test_trace {
namespace {

using namespace testing;

constexpr double kSolidAngle = 0.02;      // of a mesh, relative: rays along its outline
constexpr double kRounding = 1e-12;       // m and unit vectors
constexpr double kSinglePosition = 1e-4;  // m: single precision of a ray over some tens of metres

Scene mixed_scene(const Vec3& offset) {
  Scene scene;
  Surface ball = ellipsoid(offset + Vec3(6, 0.5, 0.2), {0.4, 0.3, 0.5}, 3);
  Material rough;
  rough.permittivity = std::complex<double>(4.0, -0.2);
  rough.scattering = 0.7;
  Material wall = rough;
  wall.mirror = true;
  add_mesh(scene, "ball", std::move(ball.vertices), std::move(ball.triangles), share(rough));
  add_rectangle(scene, "wall", offset + Vec3(-5, 2, -2), {30, 0, 0}, {0, 0, 6}, share(wall));
  add_rectangle(scene, "plate", offset + Vec3(8, -2, -1), {0, 1, 0}, {0, 0, 2}, share(Material::metal()));
  return scene;
}

TraceSettings small(int64_t num_rays = 20000) {
  TraceSettings settings = with_rays(num_rays);
  return settings;
}

bool same_bits(const Paths& a, const Paths& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return same(*a.hits, *b.hits) && same(a.offsets, b.offsets) && same(a.num_bounces, b.num_bounces) &&
         same(a.diffuse, b.diffuse) && same(a.weight, b.weight) && same(a.stratum, b.stratum);
}

TEST(Trace, BitsDoNotDependOnThreads) {
  const Scene scene = mixed_scene(Vec3::Zero());
  const Radar radar = plain_radar({0, 0, 0}, {0, 0.1, 0});
  set_num_threads(1);
  const Paths reference = trace(scene, radar, small());
  ASSERT_GT(reference.num_paths(), 10000);
  for (const int threads : {2, 3, 7}) {
    set_num_threads(threads);
    EXPECT_TRUE(same_bits(reference, trace(scene, radar, small()))) << threads;
  }
  set_num_threads(0);
}

TEST(Trace, SeedChangesTheRays) {
  const Scene scene = mixed_scene(Vec3::Zero());
  const Radar radar = plain_radar({0, 0, 0}, {0, 0.1, 0});
  TraceSettings other = small();
  other.seed = 2;
  EXPECT_FALSE(same_bits(trace(scene, radar, small()), trace(scene, radar, other)));
}

TEST(Trace, EmptySceneHasNoPaths) {
  const Paths paths = trace(Scene(), plain_radar(Vec3::Zero(), Vec3::Zero()), small());
  EXPECT_EQ(paths.num_paths(), 0);
  EXPECT_EQ(paths.num_hits(), 0);
}

// A record is well formed: every index leads somewhere, and coherent paths end in a surface that is no mirror, or have
// mirrors only.
TEST(Trace, RecordIsWellFormed) {
  const Paths paths = trace(mixed_scene(Vec3::Zero()), plain_radar({0, 0, 0}, {0, 0.1, 0}), small());
  EXPECT_NO_THROW(paths.validate());
  int64_t num_coherent = 0;
  for (int64_t i = 0; i < paths.num_paths(); ++i) {
    const auto p = static_cast<size_t>(i);
    EXPECT_LE(paths.num_bounces[p], 4);
    EXPECT_EQ(paths.diffuse[p] >> paths.num_bounces[p], 0u);
    EXPECT_TRUE(std::isfinite(paths.weight[p].real()) && std::isfinite(paths.weight[p].imag()));
    num_coherent += paths.diffuse[p] == 0 ? 1 : 0;
  }
  EXPECT_GT(num_coherent, 0);
  EXPECT_LT(num_coherent, paths.num_paths());
}

// An offset of UTM size changes nothing but the last digits of double precision (9e-10 m at 5.4e6 m).
TEST(Trace, WorldOffsetDoesNoHarm) {
  const Vec3 offset(4.5e5, 5.4e6, 120.0);
  const Vec3 receiver(0, 0.1, 0);
  const Paths near = trace(mixed_scene(Vec3::Zero()), plain_radar(Vec3::Zero(), receiver), small());
  const Paths far = trace(mixed_scene(offset), plain_radar(offset, offset + receiver), small());
  EXPECT_NEAR(static_cast<double>(far.num_paths()) / static_cast<double>(near.num_paths()), 1.0, 1e-4);
  const std::complex<double> at_origin = coherent_sum(near), at_offset = coherent_sum(far);
  double scale = 0.0;
  for (const std::complex<double>& amplitude : replayed(near).amplitudes) scale += std::norm(amplitude);
  // Relative to the level of the speckle; a ray that falls on the other side of an edge changes it by 1 / sqrt(paths) at
  // most.
  EXPECT_LT(std::abs(at_origin - at_offset), 1e-2 * std::sqrt(scale));
}

TEST(Trace, HitsLieOnTheirTriangles) {
  const Scene scene = mixed_scene(Vec3::Zero());
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  int num_hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 direction = Vec3(1.0, std::sin(0.7 * i), 0.5 * std::cos(1.3 * i)).normalized();
    RayHit hit;
    if (geometry.intersect(Vec3::Zero(), direction, hit) != EmbreeScene::Verdict::kHit) continue;
    ++num_hits;
    const auto [a, b, c] = geometry.corners(hit.hit.mesh_id, hit.hit.triangle_id);
    EXPECT_LT(std::abs(hit.normal.dot(hit.position - a)), kRounding);
    EXPECT_LT((hit.position - hit.distance * direction).norm(), kSinglePosition);
    EXPECT_LE(hit.normal.dot(direction), 0.0);
  }
  EXPECT_GT(num_hits, 100);
}

// A wall across the x axis, cut into pairs of slivers as high as it is.
void add_slivers(Scene& scene, double distance, double width, double height, int num_pairs) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (int k = 0; k <= num_pairs; ++k) {
    for (const double z : {-0.5 * height, 0.5 * height}) vertices.emplace_back(distance, (k - 0.5 * num_pairs) * width, z);
  }
  for (uint32_t k = 0; k < static_cast<uint32_t>(2 * num_pairs); k += 2) {
    triangles.push_back({k, k + 2, k + 1});
    triangles.push_back({k + 2, k + 3, k + 1});
  }
  add_mesh(scene, "slivers", std::move(vertices), std::move(triangles), share(Material::metal()));
}

// 10 m by 0.1 mm: single-precision (u, v) lose one ray in four, and leave 0.1 mm (median) to those they keep.
TEST(Trace, SliversAreMetInDoublePrecision) {
  constexpr double kDistance = 5.0;
  // m, median: 10 m times the rounding of u and v; where less rounds the ray, 10 times that
  constexpr double kPosition = 1e-6;
  Scene scene;
  add_slivers(scene, kDistance, 1e-4, 10.0, 10000);
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  const int num_rays = 5000;
  std::vector<double> errors;
  for (int i = 0; i < num_rays; ++i) {
    const Vec3 target(kDistance, 0.45 * std::sin(0.7 * i), 4.5 * std::sin(1.3 * i)), direction = target.normalized();
    RayHit hit;
    if (geometry.intersect(Vec3::Zero(), direction, hit) != EmbreeScene::Verdict::kHit) continue;
    EXPECT_LT(std::abs(hit.position.x() - kDistance), kRounding);
    errors.push_back((hit.position - target).norm());
  }
  EXPECT_GT(errors.size(), 0.999 * num_rays);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], kPosition);
  EXPECT_LT(errors[errors.size() * 99 / 100], 10.0 * kPosition);
}

// Packets answer what single rays answer, whatever stands beside them.
TEST(EmbreeScene, PacketsAnswerAsSingleRays) {
  const Scene scene = mixed_scene(Vec3::Zero());
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  std::vector<Vec3> directions;
  for (int i = 0; i < 5000; ++i) {
    directions.push_back(Vec3(std::cos(0.01 * i), std::sin(0.7 * i), 0.5 * std::cos(1.3 * i)).normalized());
  }
  EmbreeScene::PacketHits hits;
  int num_hits = 0, num_different = 0;
  std::vector<Segment> segments;
  for (size_t begin = 0; begin < directions.size();) {
    const int count = std::min(1 + static_cast<int>(begin % kPacketSize), static_cast<int>(directions.size() - begin));
    LaneVectors lanes{};
    for (int k = 0; k < count; ++k) lanes.set(k, unpacked(directions[begin + static_cast<size_t>(k)]));
    geometry.intersect(Vec3::Zero(), lanes, count, hits);
    for (int k = 0; k < count; ++k, ++begin) {
      RayHit single;
      const EmbreeScene::Verdict verdict = geometry.intersect(Vec3::Zero(), directions[begin], single);
      num_different += verdict != hits.verdicts[static_cast<size_t>(k)] ? 1 : 0;
      if (verdict != EmbreeScene::Verdict::kHit || hits.verdicts[static_cast<size_t>(k)] != verdict) continue;
      ++num_hits;
      num_different += (single.position - hits[k].position).norm() > 1e-4 ? 1 : 0;
      segments.push_back({geometry.lifted(single.position, single.normal), Vec3(12.0, 0.4 * std::sin(1.0 * num_hits), 0.2)});
    }
  }
  EXPECT_GT(num_hits, 1000);
  EXPECT_LE(num_different, 5);  // rays through an edge
  std::vector<uint8_t> blocked(segments.size());
  geometry.occluded(segments.data(), segments.size(), blocked.data());
  int num_blocked = 0, num_other = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    num_blocked += blocked[i];
    num_other += blocked[i] != (geometry.occluded(segments[i].from, segments[i].to) ? 1 : 0) ? 1 : 0;
  }
  EXPECT_GT(num_blocked, 20);
  EXPECT_LE(num_other, 5);
}

// Rays that own what they meet, each over its density, add up to the solid angle of what there is to see.
TEST(Launch, OwnersCoverEachSurfaceOnce) {
  const Scene scene = mixed_scene(Vec3::Zero());
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  LaunchSettings settings;
  settings.num_rays = 200000;
  const std::vector<Mirror> mirrors = find_mirrors(scene, geometry);
  const MirrorFrusta frusta = FrustumFinder(mirrors, &geometry).find(settings.transmitter, {});
  settings.frusta = frusta.frusta;
  const LaunchPlan plan = plan_launch(scene, geometry, mirrors, settings);
  ASSERT_EQ(plan.first_ray.back(), settings.num_rays);
  ASSERT_GE(plan.strata.size(), 4u);  // ball, plate, an image, the field of view
  const LaunchDirections directions(plan.strata);
  std::vector<double> owned(scene.meshes().size()), seen(scene.meshes().size());  // sr, by mesh
  const auto shoot = [&](const Vec3& direction, const auto& count) {
    EXPECT_NEAR(direction.norm(), 1.0, kRounding);
    RayHit hit;
    if (geometry.intersect(Vec3::Zero(), direction, hit) == EmbreeScene::Verdict::kHit) count(hit.hit.mesh_id);
  };
  for (int64_t ray = 0; ray < settings.num_rays; ++ray) {
    const int stratum = plan.stratum_of(ray);
    const Vec3 direction = directions.direction(stratum, plan.point_of(stratum, ray));
    EXPECT_TRUE(plan.strata[static_cast<size_t>(stratum)].contains((1.0 - 1e-12) * direction)) << ray;
    shoot(direction, [&](uint32_t mesh) {
      if (plan.owners.owner(mesh, kNoMirrors) == stratum) owned[mesh] += 1.0 / plan.density(stratum);
    });
  }
  constexpr int64_t kEven = 1000000;  // directions over the whole sphere, for comparison
  const LaunchLattice lattice(LaunchDomain{}, kEven, {Eigen::Vector2d(0.3, 0.8)});
  const LaunchDirections sphere({Stratum{}});
  for (int64_t i = 0; i < kEven; ++i) {
    shoot(sphere.direction(0, lattice.point(i)), [&](uint32_t mesh) { seen[mesh] += 4 * kPi / kEven; });
  }
  for (size_t mesh = 0; mesh < owned.size(); ++mesh) EXPECT_NEAR(owned[mesh] / seen[mesh], 1.0, kSolidAngle) << mesh;
}

TEST(Launch, PlanningHeedsCancelling) {
  const Scene scene = mixed_scene(Vec3::Zero());
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  Job job;
  LaunchSettings settings;
  settings.num_rays = 1000;
  settings.job = &job;
  EXPECT_NO_THROW(plan_launch(scene, geometry, {}, settings));
  job.cancel();
  EXPECT_THROW(plan_launch(scene, geometry, {}, settings), Cancelled);
}

TEST(Trace, BadInputIsNamed) {
  const auto message = [](const Scene& scene, const Radar& radar, const TraceSettings& settings) {
    return test::error_text([&] { trace(scene, radar, settings); });
  };
  const Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  TraceSettings no_rays = small(0), many = small(), late = small();
  many.max_bounces = 65;
  late.start_time = std::nan("");
  EXPECT_NE(message(Scene(), radar, no_rays).find("num_rays: must lie in [1, 10000000000], got 0"), std::string::npos);
  EXPECT_NE(message(Scene(), radar, many).find("max_bounces"), std::string::npos);
  EXPECT_NE(message(Scene(), radar, late).find("start_time"), std::string::npos);

  Scene bent;
  add_mesh(bent, "bent", {{5, 0, 0}, {5, 1, 0}, {5, 1, 1}, {5.5, 0, 1}}, {{0, 1, 2}, {0, 2, 3}},
           share(Material::metal(true)));
  EXPECT_EQ(message(bent, radar, small()), "no error");  // its two planes are mirrors
  Node smooth = bent.nodes().front();
  smooth.smooth = true;
  bent.change(0, smooth);
  EXPECT_NE(message(bent, radar, small()).find("'bent' must be flat"), std::string::npos);

  Scene brief;
  const auto motion =
      std::make_shared<KeyframeMotion>(std::vector<double>{0.0, 1e-6}, std::vector<Vec3>{Vec3::Zero(), Vec3::UnitX()},
                                       std::vector<Quaternion>{}, Interpolation::kLinear);
  add_rectangle(brief, "brief", {5, 0, 0}, {0, 1, 0}, {0, 0, 1}, lambert(0.5), motion);
  EXPECT_NE(message(brief, radar, small()).find("brief"), std::string::npos);
}

TEST(Trace, CancellingStopsIt) {
  Job job;
  job.cancel();
  EXPECT_THROW(trace(mixed_scene(Vec3::Zero()), plain_radar(Vec3::Zero(), Vec3::Zero()), small(), &job), Cancelled);
}

TEST(Paths, SelectionSharesTheHits) {
  const Paths paths = trace(mixed_scene(Vec3::Zero()), plain_radar(Vec3::Zero(), {0, 0.1, 0}), small(2000));
  std::vector<uint8_t> keep(static_cast<size_t>(paths.num_paths()), 0);
  keep[3] = keep[7] = 1;
  const Paths some = paths.select(keep);
  EXPECT_EQ(some.hits.get(), paths.hits.get());
  EXPECT_EQ(some.num_paths(), 2);
  EXPECT_EQ(some.offsets[1], paths.offsets[7]);
  EXPECT_THROW(paths.select({1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_trace
