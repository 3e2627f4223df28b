// Paths over mirrors, and the search behind them, against loops over all sequences, boxes, frusta and points.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "cpp/support/any_threads.h"
#include "cpp/support/sanitized.h"
#include "cpp/support/scenes.h"
#include "cpp/support/slow_images.h"
#include "echopath/trace/frusta/frustum_locator.h"
#include "echopath/trace/trace.h"

namespace echopath::test_mirror_paths {
namespace {

using testing::MirrorRectangle;
using Sequences = std::set<std::vector<int>>;

MaterialPtr metal_mirror() {
  Material material;
  material.conductor = true;
  material.mirror = true;
  return testing::share(material);
}

Scene scene_of(const std::vector<MirrorRectangle>& rectangles) {
  Scene scene;
  for (size_t i = 0; i < rectangles.size(); ++i) {
    testing::add_rectangle(scene, "mirror_" + std::to_string(i), rectangles[i].corner, rectangles[i].a, rectangles[i].b,
                           metal_mirror());
  }
  return scene;
}

std::vector<MirrorRectangle> random_mirrors(int count, unsigned seed) {
  std::mt19937 draw(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vec3(uniform(draw), uniform(draw), uniform(draw)); };
  std::vector<MirrorRectangle> mirrors;
  for (int i = 0; i < count; ++i) {
    const Vec3 a = 5.0 * vector(), towards = vector();
    mirrors.push_back({6.0 * vector(), a, 4.0 * (towards - towards.dot(a) / a.squaredNorm() * a).normalized()});
  }
  return mirrors;
}

Paths traced(const std::vector<MirrorRectangle>& rectangles, const Vec3& transmitter, const Vec3& receiver,
             int max_bounces) {
  return trace(scene_of(rectangles), testing::plain_radar(transmitter, receiver), testing::with_rays(1, max_bounces));
}

// A room of six walls with a slanting board in it.
std::vector<MirrorRectangle> room_with_a_board() {
  const Vec3 x(5.0, 0.0, 0.0), y(0.0, 4.3, 0.0), z(0.0, 0.0, 3.1);
  const Vec3 along(1.1, 0.7, 0.2), towards(-0.3, 0.4, 0.9);
  const Vec3 across = towards - towards.dot(along) / along.squaredNorm() * along;
  return {{Vec3::Zero(), x, y},
          {z, x, y},
          {Vec3::Zero(), y, z},
          {x, y, z},
          {Vec3::Zero(), x, z},
          {y, x, z},
          {{2.1, 1.9, 0.8}, along, across}};
}

// Of the paths of the image method; each mirror is the mesh of the same number.
std::vector<std::vector<int>> sequences_of(const Paths& paths) {
  std::vector<std::vector<int>> found;
  const std::vector<Hit>& hits = *paths.hits;
  for (size_t i = 0; i < static_cast<size_t>(paths.num_paths()); ++i) {
    if (paths.stratum[i] != kNoStratum) continue;
    std::vector<int>& sequence = found.emplace_back();
    for (int k = 0; k < paths.num_bounces[i]; ++k) {
      sequence.push_back(static_cast<int>(hits[static_cast<size_t>(paths.offsets[i] + k)].mesh_id));
    }
  }
  return found;
}

void expect_same(const Paths& paths, const testing::SlowPaths& slow, size_t least) {
  const std::vector<std::vector<int>> list = sequences_of(paths);
  const Sequences found(list.begin(), list.end());
  EXPECT_EQ(found.size(), list.size());
  for (const std::vector<int>& sequence : slow.found) {
    EXPECT_TRUE(found.contains(sequence)) << ::testing::PrintToString(sequence) << " is missing";
  }
  for (const std::vector<int>& sequence : found) {
    EXPECT_TRUE(slow.found.contains(sequence) || slow.unsure.contains(sequence)) << ::testing::PrintToString(sequence);
  }
  EXPECT_GE(slow.found.size(), least);
  EXPECT_EQ(paths.frame.statistics.num_unfollowed_frusta, 0);
}

TEST(MirrorPaths, ACityOf400MirrorsHasThePathsOfAllSequencesOfThree) {
  const auto mirrors = testing::city_block(test::kIsSanitized ? 16 : 80);
  const Vec3 transmitter(9.3, 8.7, 3.1), receiver(11.2, -29.6, 2.3);
  const testing::SlowPaths slow = testing::slow_mirror_paths(transmitter, receiver, mirrors, 3);
  expect_same(traced(mirrors, transmitter, receiver, 3), slow, test::kIsSanitized ? 1 : 10);
}

TEST(MirrorPaths, SequencesOfAnyLengthMeetHalfway) {
  const Vec3 transmitter(1.3, 0.7, 1.9), receiver(4.1, 2.6, 0.6);
  const auto mirrors = room_with_a_board();
  expect_same(traced(mirrors, transmitter, receiver, 6), testing::slow_mirror_paths(transmitter, receiver, mirrors, 6), 100);
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const auto others = random_mirrors(7, seed);
    expect_same(traced(others, transmitter, receiver, 4), testing::slow_mirror_paths(transmitter, receiver, others, 4), 0);
  }
}

// Over an odd number of mirrors the search goes farther from the antenna with fewer frusta.
TEST(MirrorPaths, AreTheSameBothWays) {
  const auto mirrors = testing::city_block(40);
  const Vec3 one(9.3, 8.7, 3.1), other(11.2, -29.6, 2.3);
  for (const int max_bounces : {1, 3}) {
    std::vector<std::vector<int>> there = sequences_of(traced(mirrors, one, other, max_bounces)),
                                  back = sequences_of(traced(mirrors, other, one, max_bounces));
    EXPECT_EQ(there.back().size(), static_cast<size_t>(max_bounces));
    for (std::vector<int>& sequence : back) std::reverse(sequence.begin(), sequence.end());
    std::sort(there.begin(), there.end());
    std::sort(back.begin(), back.end());
    EXPECT_EQ(there, back);
  }
}

TEST(MirrorPaths, AreInOrderWhateverTheNumberOfThreads) {
  const auto mirrors = testing::city_block(20);
  for (const int max_bounces : {3, 4}) {
    const auto found = test::same_on_any_threads(
        [&] { return sequences_of(traced(mirrors, {9.3, 8.7, 3.1}, {11.2, -29.6, 2.3}, max_bounces)); });
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return a.size() != b.size() ? a.size() < b.size() : a < b;
    }));
    EXPECT_GT(found.size(), max_bounces == 3 ? 1u : 3u);
  }
}

std::vector<Mirror> mirrors_of(const std::vector<MirrorRectangle>& rectangles) {
  std::vector<Mirror> mirrors;
  for (const MirrorRectangle& r : rectangles) {
    Mirror& mirror = mirrors.emplace_back();
    mirror.mesh_id = static_cast<uint32_t>(mirrors.size() - 1);
    mirror.point = r.corner;
    mirror.normal = r.a.cross(r.b).normalized();
    mirror.outline = {r.corner, r.corner + r.a, r.corner + r.a + r.b, r.corner + r.b};
  }
  return mirrors;
}

TEST(MirrorFrusta, BeyondTheBoundAreCounted) {
  const auto mirrors = mirrors_of(random_mirrors(12, 6));
  const FrustumFinder finder(mirrors);
  const MirrorFrusta all = finder.find({0.1, 0.2, 0.3}, {.max_mirrors = 3});
  const MirrorFrusta few = finder.find({0.1, 0.2, 0.3}, {.max_mirrors = 3, .max_frusta = 5});
  EXPECT_EQ(all.num_unfollowed, 0);
  ASSERT_GT(all.frusta.size(), few.frusta.size());
  // Those over one mirror are always there; none of them was followed.
  EXPECT_EQ(few.num_unfollowed, std::ssize(few.frusta));
  for (size_t i = 0; i < few.frusta.size(); ++i) EXPECT_EQ(few.frusta[i].mirrors, all.frusta[i].mirrors);
}

std::vector<std::vector<int>> sequences_of(const MirrorFrusta& found) {
  std::vector<std::vector<int>> sequences;
  for (const MirrorFrustum& frustum : found.frusta) sequences.push_back(frustum.mirrors);
  return sequences;
}

TEST(MirrorFrusta, HiddenWindowsAreKeptOnRequestWhileThereIsRoom) {
  const Scene scene = scene_of(testing::city_block(20));
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  const std::vector<Mirror> mirrors = find_mirrors(scene, geometry);
  const FrustumFinder finder(mirrors, &geometry);
  const Vec3 antenna(9.3, 8.7, 3.1);
  MirrorFrusta seen = finder.find(antenna, {.max_mirrors = 1}), all = seen, crowded = seen;
  finder.lengthen(antenna, {.max_mirrors = 2}, seen);
  finder.lengthen(antenna, {.max_mirrors = 2, .keeps_hidden = true}, all);
  finder.lengthen(antenna, {.max_mirrors = 2, .max_frusta = crowded.frusta.size() + 1, .keeps_hidden = true}, crowded);
  EXPECT_EQ(sequences_of(seen), sequences_of(finder.find(antenna, {.max_mirrors = 2})));
  EXPECT_EQ(sequences_of(crowded), sequences_of(seen));
  EXPECT_GT(all.frusta.size(), seen.frusta.size());
  const std::vector<std::vector<int>> of_all = sequences_of(all);
  for (const std::vector<int>& sequence : sequences_of(seen))
    EXPECT_NE(std::find(of_all.begin(), of_all.end(), sequence), of_all.end());
}

TEST(FrustumLocator, HoldsAllFrustaThatReachAPointInTheirOrder) {
  const auto mirrors = mirrors_of(random_mirrors(40, 7));
  const std::vector<MirrorFrustum> frusta = FrustumFinder(mirrors).find({0.1, 0.2, 0.3}, {}).frusta;
  const FrustumLocator locator(frusta, 1e-3);
  std::mt19937 draw(8);
  std::uniform_real_distribution<double> uniform(-15.0, 15.0);
  size_t num_reaching = 0, num_near = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 point(uniform(draw), uniform(draw), uniform(draw));
    const std::span<const int> near = locator.near(point);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    num_near += near.size();
    for (int k = 0; k < std::ssize(frusta); ++k) {
      if (!frusta[static_cast<size_t>(k)].reaches(point, 1e-3)) continue;
      ++num_reaching;
      EXPECT_TRUE(std::binary_search(near.begin(), near.end(), k));
    }
  }
  EXPECT_GT(frusta.size(), 200u);
  EXPECT_GT(num_reaching, 1000u);
  EXPECT_LT(num_near, 2000 * frusta.size() / 5);  // else it would be no help
}

// Cells are halved where points come first, whichever thread brings them.
TEST(FrustumLocator, FindsTheSameForThreadsSideBySide) {
  const auto mirrors = mirrors_of(random_mirrors(40, 7));
  const std::vector<MirrorFrustum> frusta = FrustumFinder(mirrors).find({0.1, 0.2, 0.3}, {}).frusta;
  const FrustumLocator alone(frusta, 1e-3), shared(frusta, 1e-3);
  std::mt19937 draw(8);
  std::uniform_real_distribution<double> uniform(-8.0, 8.0);
  std::vector<std::pair<Vec3, std::span<const int>>> looked_up(4000);
  for (auto& [point, near] : looked_up) point = {uniform(draw), uniform(draw), uniform(draw)};
  parallel_for(std::ssize(looked_up), [&](int64_t i) {
    auto& [point, near] = looked_up[static_cast<size_t>(i)];
    near = shared.near(point);
  });
  for (const auto& [point, near] : looked_up) EXPECT_TRUE(std::ranges::equal(near, alone.near(point)));
}

TEST(BoxHierarchy, FindsTheBoxesThatALoopFinds) {
  std::mt19937 draw(9);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vec3(uniform(draw), uniform(draw), uniform(draw)); };
  std::vector<Eigen::AlignedBox3d> boxes;
  for (int i = 0; i < 300; ++i) {
    const Vec3 corner = 10.0 * vector();
    boxes.emplace_back(corner, corner + vector().cwiseAbs());
  }
  const BoxHierarchy tree(boxes);
  std::vector<int> found;
  for (int i = 0; i < 200; ++i) {
    std::vector<HalfSpace> region;
    for (int k = 0; k < i % 6; ++k) region.push_back({vector().normalized(), 4.0 * uniform(draw)});
    tree.find(region, found);
    std::vector<int> slow;
    for (int k = 0; k < 300; ++k) {
      bool is_in = true;
      for (const HalfSpace& half : region) {
        double farthest = -1e9;
        for (int corner = 0; corner < 8; ++corner) {
          farthest = std::max(
              farthest,
              half.normal.dot(boxes[static_cast<size_t>(k)].corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner))));
        }
        is_in = is_in && farthest >= half.offset;
      }
      if (is_in) slow.push_back(k);
    }
    EXPECT_EQ(found, slow);
  }
  BoxHierarchy({}).find({}, found);
  EXPECT_TRUE(found.empty());
}

// What can be seen of a mirror lies in what shadows leave of it, and of a house one sees no back.
TEST(FrustumShadows, LeaveAllThatIsSeenAndHideTheBacksOfHouses) {
  const auto rectangles = testing::city_block(20);
  const Scene scene = scene_of(rectangles);
  const PosedScene pose(scene, 0.0);
  const EmbreeScene geometry(scene, pose, Vec3::Zero());
  const std::vector<Mirror> mirrors = find_mirrors(scene, geometry);
  const Vec3 antenna(9.3, 8.7, 3.1);
  const FrustumShadows shadows(geometry, mirrors, {});
  std::mt19937 draw(10);
  std::uniform_real_distribution<double> inside(0.01, 0.99);  // off the rims, where rounding decides
  size_t num_hidden = 0, num_seen = 0;
  for (size_t m = 0; m < mirrors.size(); ++m) {
    std::vector<Vec3> window = mirrors[m].outline;
    shadows.shrink({antenna}, mirrors[m], window);
    num_hidden += window.empty();
    const std::vector<Vec3> rims = window.empty() ? std::vector<Vec3>() : rims_of(window, antenna);
    for (int i = 0; i < 400; ++i) {
      const Vec3 point = rectangles[m].corner + inside(draw) * rectangles[m].a + inside(draw) * rectangles[m].b;
      if (geometry.occluded(antenna, point + 1e-3 * (antenna - point).normalized())) continue;
      ++num_seen;
      ASSERT_FALSE(window.empty()) << m;
      for (const Vec3& rim : rims) EXPECT_GT(rim.dot(point - antenna), -1e-3) << m;
    }
  }
  EXPECT_GT(num_seen, 1000u);
  EXPECT_GT(num_hidden, mirrors.size() / 2);
}

// A board stands before a wall, half of which another mirror hides: with and without the board, the mirrors alone leave the
// other half; all surfaces leave nothing behind the board.
TEST(FrustumShadows, DoNotHangOnWhatCastsNone) {
  Scene scene;
  testing::add_rectangle(scene, "wall", {10, -1, -1}, {0, 2, 0}, {0, 0, 2}, metal_mirror());
  testing::add_rectangle(scene, "half", {9, -0.2, -1}, {0, 1.2, 0}, {0, 0, 2}, metal_mirror());
  Scene with_board = scene;
  testing::add_rectangle(with_board, "board", {5, -1, -1}, {0, 2, 0}, {0, 0, 2}, testing::lambert(0.5));
  const auto left = [](const Scene& of, ShadowCasters casters) {
    const EmbreeScene geometry(of, PosedScene(of, 0.0), Vec3::Zero());
    const std::vector<Mirror> mirrors = find_mirrors(of, geometry);
    std::vector<Vec3> window = mirrors.front().outline;
    FrustumShadows(geometry, mirrors, std::move(casters)).shrink({Vec3::Zero()}, mirrors.front(), window);
    return window;
  };
  EXPECT_TRUE(left(with_board, {}).empty());
  const std::vector<Vec3> free = left(scene, {true, true});
  ASSERT_FALSE(free.empty());
  for (const Vec3& corner : free) EXPECT_LT(corner.y(), -0.2);
  EXPECT_EQ(left(with_board, {true, true, false}), free);
}

}  // namespace
}  // namespace echopath::test_mirror_paths
