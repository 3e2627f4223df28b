// Images on planes that nobody flagged, against loops over all sequences and the closed form of an endless plane.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <map>
#include <set>

#include "cpp/support/any_threads.h"
#include "cpp/support/sanitized.h"
#include "cpp/support/scenes.h"
#include "cpp/support/slow_images.h"
#include "echopath/trace/trace.h"

namespace echopath::test_plane_images {
namespace {

using testing::MirrorRectangle;
using Sequences = std::set<std::vector<int>>;

constexpr double kFieldTolerance = 1e-6;  // single precision of the weight

MaterialPtr metal(bool mirror) {
  Material material;
  material.conductor = true;
  material.mirror = mirror;
  return testing::share(material);
}

void add_house(Scene& scene, const std::string& name, const MirrorRectangle* faces, int count, const MaterialPtr& material) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const auto& [corner, a, b] = faces[i];
    const auto first = static_cast<uint32_t>(vertices.size());
    for (const Vec3& vertex : {corner, Vec3(corner + a), Vec3(corner + a + b), Vec3(corner + b)}) vertices.push_back(vertex);
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
  }
  testing::add_mesh(scene, name, vertices, triangles, material);
}

// The ground and houses of five rectangles, each one mesh.
Scene houses(const std::vector<MirrorRectangle>& rectangles, bool mirror) {
  Scene scene;
  add_house(scene, "ground", rectangles.data(), 1, metal(mirror));
  for (size_t i = 1; i < rectangles.size(); i += 5)
    add_house(scene, "house_" + std::to_string(i), rectangles.data() + i, 5, metal(mirror));
  return scene;
}

// Waves so short that every surface is larger than its Fresnel zone.
Radar short_waves(const Vec3& transmitter, const Vec3& receiver) {
  Radar radar = testing::plain_radar(transmitter, receiver);
  radar.waveform.start_frequency = 1e12;
  return radar;
}

Sequences image_sequences(const Paths& paths) {
  Sequences found;
  int count = 0;
  for (size_t i = 0; i < static_cast<size_t>(paths.num_paths()); ++i) {
    if (paths.stratum[i] != kNoStratum) continue;
    std::vector<int> sequence;
    for (int k = 0; k < paths.num_bounces[i]; ++k) {
      const Hit& hit = paths.hits_of(static_cast<int64_t>(i))[k];
      const int mesh = static_cast<int>(hit.mesh_id), face = static_cast<int>(hit.triangle_id) / 2;
      sequence.push_back(mesh == 0 ? 0 : 1 + 5 * (mesh - 1) + face);
    }
    found.insert(sequence);
    ++count;
  }
  EXPECT_EQ(static_cast<int>(found.size()), count);
  return found;
}

Paths traced(const Scene& scene, const Radar& radar, int64_t num_rays, int max_bounces) {
  return trace(scene, radar, testing::with_rays(num_rays, max_bounces));
}

TEST(PlaneImages, RaysShowAllPathsOfACityOfHouses) {
  const auto rectangles = testing::city_block(test::kIsSanitized ? 9 : 20);
  const Vec3 transmitter(9.3, 8.7, 3.1), receiver(11.2, -29.6, 2.3);
  const testing::SlowPaths slow = testing::slow_mirror_paths(transmitter, receiver, rectangles, 2);
  const Sequences found = image_sequences(traced(houses(rectangles, false), short_waves(transmitter, receiver), 100'000, 2));
  for (const auto& sequence : slow.found) EXPECT_TRUE(found.contains(sequence)) << ::testing::PrintToString(sequence);
  for (const auto& sequence : found) {
    EXPECT_TRUE(slow.found.contains(sequence) || slow.unsure.contains(sequence)) << ::testing::PrintToString(sequence);
  }
  EXPECT_GE(slow.found.size(), test::kIsSanitized ? 1u : 4u);
}

TEST(PlaneImages, FacesOfFlaggedHousesAreMirrorsOfTheirOwn) {
  const auto rectangles = testing::city_block(test::kIsSanitized ? 4 : 20);
  const Vec3 transmitter(9.3, 8.7, 3.1), receiver(11.2, -29.6, 2.3);
  const testing::SlowPaths slow = testing::slow_mirror_paths(transmitter, receiver, rectangles, 3);
  const Sequences found = image_sequences(traced(houses(rectangles, true), short_waves(transmitter, receiver), 1, 3));
  for (const auto& sequence : slow.found) EXPECT_TRUE(found.contains(sequence)) << ::testing::PrintToString(sequence);
  for (const auto& sequence : found) {
    EXPECT_TRUE(slow.found.contains(sequence) || slow.unsure.contains(sequence)) << ::testing::PrintToString(sequence);
  }
}

// Returns the one coherent path that lies on a square of that width at x = 10 m before the radar.
std::vector<size_t> coherent_paths(const Paths& paths) {
  std::vector<size_t> out;
  for (size_t i = 0; i < static_cast<size_t>(paths.num_paths()); ++i) {
    if (paths.diffuse[i] == 0) out.push_back(i);
  }
  return out;
}

Paths before_a_square(double width) {
  Scene scene;
  testing::add_rectangle(scene, "wall", {10.0, -0.51 * width, -0.49 * width}, {0, width, 0}, {0, 0, width}, metal(false));
  return traced(scene, testing::plain_radar(Vec3::Zero(), Vec3(0, 0.1, 0)), 20'000, 2);
}

TEST(PlaneImages, AWallLargerThanItsZoneIsOnePathAndASmallerOneIsNone) {
  const Paths wall = before_a_square(5.0);
  ASSERT_EQ(coherent_paths(wall).size(), 1u);
  EXPECT_EQ(wall.stratum[coherent_paths(wall)[0]], kNoStratum);
  EXPECT_NEAR(std::abs(wall.weight[coherent_paths(wall)[0]]), 1.0, kFieldTolerance);
  const Paths plate = before_a_square(0.2);
  EXPECT_GT(coherent_paths(plate).size(), 100u);
  for (const size_t path : coherent_paths(plate)) EXPECT_NE(plate.stratum[path], kNoStratum);
}

// Bytes of memory that the process had in use at most, so far.
int64_t peak_memory() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return int64_t{usage.ru_maxrss} * 1024;
}

constexpr int64_t kMiB = 1 << 20;

// Between two endless plates there are two paths of every number of bounces: one begins at either plate.
TEST(PlaneImages, TwoLongPlatesHaveTwoPathsOfEveryNumberOfBounces) {
  Scene scene;
  for (const double y : {-1.5, 1.5})
    testing::add_rectangle(scene, y < 0 ? "right" : "left", {-50, y, -20}, {100, 0, 0}, {0, 0, 40}, metal(false));
  const int64_t before = peak_memory();
  const Paths paths = traced(scene, short_waves({0, 0.1, 0}, {1, -0.1, 0.2}), 20'000, 64);
  std::map<int, int> found;
  for (size_t i = 0; i < static_cast<size_t>(paths.num_paths()); ++i) {
    if (paths.stratum[i] == kNoStratum) ++found[paths.num_bounces[i]];
  }
  ASSERT_EQ(found.size(), 64u);
  for (const auto& [bounces, count] : found) EXPECT_EQ(count, 2) << bounces;
  EXPECT_LT(peak_memory() - before, test::kIsSanitized ? 2000 * kMiB : 200 * kMiB);
}

// In a closed room every ray goes by near the receiver after every bounce, once its neighbours are far enough apart.
TEST(PlaneImages, ManyBouncesInARoomTakeMemoryLikeTheRecord) {
  Scene scene;
  const MirrorRectangle walls[] = {{{0, 0, 0}, {5, 0, 0}, {0, 4.3, 0}},   {{0, 0, 3.1}, {5, 0, 0}, {0, 4.3, 0}},
                                   {{0, 0, 0}, {0, 4.3, 0}, {0, 0, 3.1}}, {{5, 0, 0}, {0, 4.3, 0}, {0, 0, 3.1}},
                                   {{0, 0, 0}, {5, 0, 0}, {0, 0, 3.1}},   {{0, 4.3, 0}, {5, 0, 0}, {0, 0, 3.1}}};
  add_house(scene, "room", walls, 6, metal(false));
  const int64_t before = peak_memory();
  const Paths paths = traced(scene, testing::plain_radar({1.3, 0.7, 1.9}, {4.1, 2.6, 0.6}), 2'000, 64);
  EXPECT_GT(paths.num_paths(), 50'000);
  EXPECT_LT(peak_memory() - before, test::kIsSanitized ? 2000 * kMiB : 70 * kMiB);
}

TEST(PlaneImages, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = houses(testing::city_block(9), false);
  const Radar radar = short_waves({9.3, 8.7, 3.1}, {11.2, -29.6, 2.3});
  const auto columns = [&] {
    const Paths paths = traced(scene, radar, 20'000, 3);
    return std::tuple(paths.weight, paths.offsets, paths.stratum);
  };
  test::same_on_any_threads(columns, {3});
}

}  // namespace
}  // namespace echopath::test_plane_images
