#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "cpp/support/any_threads.h"
#include "cpp/support/expect_error.h"
#include "echopath/base/box_tree.h"
#include "echopath/base/constants.h"
#include "echopath/motion/motion.h"
#include "echopath/scene/overlap/coplanar.h"

namespace echopath::test_coplanar {
namespace {

using test::expect_error;
using Invalid = std::invalid_argument;

constexpr double kAreaShare = 1e-7;    // of 1 m^2: corners at UTM coordinates are known to 9e-10 m
constexpr double kDistance = 4e-9;     // m, likewise
constexpr double kRounding = 1e-12;    // m^2
constexpr double kMovedNormal = 1e-9;  // m and m^2: seen along the normal of the one or of the other
const Vec3 kUtm(450'000.0, 5'400'000.0, 120.0);

struct Soup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

// [x0, x0 + width] x [y0, y0 + height] at z, of n x n pairs of triangles.
Soup rectangle(double x0, double y0, double width, double height, double z = 0.0, uint32_t n = 1) {
  Soup made;
  for (uint32_t j = 0; j <= n; ++j) {
    for (uint32_t i = 0; i <= n; ++i) made.vertices.push_back({x0 + width * i / n, y0 + height * j / n, z});
  }
  for (uint32_t j = 0; j < n; ++j) {
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      made.triangles.insert(made.triangles.end(), {{a, b, d}, {a, d, c}});
    }
  }
  return made;
}

Soup turned_over(Soup soup) {
  for (Triangle& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
  return soup;
}

Soup both(Soup one, const Soup& two) {
  const auto offset = static_cast<uint32_t>(one.vertices.size());
  one.vertices.insert(one.vertices.end(), two.vertices.begin(), two.vertices.end());
  for (const Triangle& t : two.triangles) one.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return one;
}

Transform random_place(uint32_t seed, const Vec3& offset = Vec3::Zero()) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Quaternion turn = Quaternion(normal(random), normal(random), normal(random), normal(random)).normalized();
  return Eigen::Translation3d(offset + Vec3(normal(random), normal(random), normal(random))) * turn;
}

void add(Scene& scene, const Soup& soup, const Transform& placement = Transform::Identity(),
         std::shared_ptr<const Motion> motion = nullptr) {
  Node node;
  node.name = "mesh " + std::to_string(scene.meshes().size());
  node.mesh = std::make_shared<const Mesh>(soup.vertices, soup.triangles);
  node.material = std::make_shared<const Material>(Material::metal());
  node.placement = placement;
  node.motion = std::move(motion);
  scene.add(node);
}

Scene scene_of(const std::vector<Soup>& soups, const Transform& placement = Transform::Identity()) {
  Scene scene;
  for (const Soup& soup : soups) add(scene, soup, placement);
  return scene;
}

double area_between(const Soup& one, const Soup& two, const Transform& placement = Transform::Identity()) {
  const auto found = coplanar_overlaps(scene_of({one, two}, placement));
  return found.empty() ? 0.0 : found[0].area;
}

TEST(Coplanar, SquaresOverlapByTheProductOfTheirOverlappingSides) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const Transform place = random_place(seed, kUtm);
    const auto found = coplanar_overlaps(scene_of({rectangle(0, 0, 1, 1), rectangle(0.3, 0.4, 1, 1)}, place));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].first_mesh_id, 0u);
    EXPECT_EQ(found[0].second_mesh_id, 1u);
    EXPECT_EQ(found[0].num_triangles, 4);
    EXPECT_NEAR(found[0].area, 0.7 * 0.6, kAreaShare);
    EXPECT_LT(found[0].distance, kDistance);
  }
}

TEST(Coplanar, TwentyMicrometresApartIsNoOverlapAndFiveAreOne) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const Transform place = random_place(seed, kUtm);
    EXPECT_TRUE(coplanar_overlaps(scene_of({rectangle(0, 0, 1, 1), rectangle(0, 0, 1, 1, 20e-6)}, place)).empty());
    const auto found = coplanar_overlaps(scene_of({rectangle(0, 0, 1, 1), rectangle(0, 0, 1, 1, 5e-6)}, place));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].area, 1.0, kAreaShare);
    EXPECT_NEAR(found[0].distance, 5e-6, kDistance);
    EXPECT_TRUE(coplanar_overlaps(scene_of({rectangle(0, 0, 1, 1), rectangle(0, 0, 1, 1, 5e-6)}, place), 0.0, 4e-6).empty());
  }
}

TEST(Coplanar, WhatMerelyTouchesDoesNotOverlap) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const Transform place = random_place(seed, kUtm);
    EXPECT_EQ(area_between(rectangle(0, 0, 1, 1), rectangle(1, 0, 1, 1), place), 0.0);         // along an edge
    EXPECT_EQ(area_between(rectangle(0, 0, 1, 1), rectangle(1, 0.3, 1, 1), place), 0.0);       // edges that are shifted
    EXPECT_EQ(area_between(rectangle(0, 0, 1, 1), rectangle(1, 1, 1, 1), place), 0.0);         // at a corner
    EXPECT_EQ(area_between(rectangle(0, 0, 1, 1), rectangle(1 - 5e-6, 0, 1, 1), place), 0.0);  // by less than the distance
    EXPECT_NEAR(area_between(rectangle(0, 0, 1, 1), rectangle(1 - 1e-3, 0, 1, 1), place), 1e-3, 1e-5 * 1e-3 + kAreaShare);
  }
}

TEST(Coplanar, WhicheverWayTheyFace) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const Transform place = random_place(seed);
    EXPECT_NEAR(area_between(rectangle(0, 0, 1, 1), turned_over(rectangle(0.5, 0, 1, 1)), place), 0.5, kAreaShare);
    EXPECT_NEAR(area_between(turned_over(rectangle(0, 0, 1, 1)), rectangle(0.5, 0, 1, 1), place), 0.5, kAreaShare);
  }
}

TEST(Coplanar, AMeshMayLieOnItself) {
  const Soup square = rectangle(0, 0, 1, 1);
  const auto twice = coplanar_overlaps(scene_of({both(square, square)}, random_place(1)));
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_EQ(twice[0].first_mesh_id, 0u);
  EXPECT_EQ(twice[0].second_mesh_id, 0u);
  EXPECT_EQ(twice[0].num_triangles, 4);
  EXPECT_NEAR(twice[0].area, 1.0, kAreaShare);
  const auto three_times = coplanar_overlaps(scene_of({both(both(square, square), square)}, random_place(2)));
  EXPECT_EQ(three_times[0].num_triangles, 6);
  EXPECT_NEAR(three_times[0].area, 3.0, kAreaShare);  // three pairs
}

// No two of these cuts are closer than 10 um: what triangles overlap by less does not count.
TEST(Coplanar, AreasDoNotDependOnHowSurfacesAreCutIntoTriangles) {
  for (uint32_t seed = 0; seed < 5; ++seed) {
    const Transform place = random_place(seed, kUtm);
    const Soup one = rectangle(0, 0, 1, 1);
    for (const uint32_t n : {1u, 7u, 24u}) {
      const Soup cut = rectangle(0.23, 0.41, 1, 1, 0, n);
      EXPECT_NEAR(area_between(one, cut, place), 0.77 * 0.59, kAreaShare);
      EXPECT_NEAR(area_between(rectangle(0, 0, 1, 1, 0, 10), cut, place), 0.77 * 0.59, kAreaShare);
    }
  }
}

TEST(Coplanar, SurfacesThatCrossOrBendAreNotOne) {
  const Soup square = rectangle(-0.5, -0.5, 1, 1);
  for (const double angle : {1e-3, 1e-2, 0.3, 1.0, kPi / 2.0}) {
    Scene scene = scene_of({square});
    add(scene, square, Transform(Eigen::AngleAxisd(angle, Vec3::UnitX())));
    EXPECT_TRUE(coplanar_overlaps(scene).empty()) << angle;
  }
  Scene nearly = scene_of({square});
  add(nearly, square, Transform(Eigen::AngleAxisd(1e-5, Vec3::UnitX())));  // 5 um at the rim
  ASSERT_EQ(coplanar_overlaps(nearly).size(), 1u);
  EXPECT_NEAR(coplanar_overlaps(nearly)[0].distance, 5e-6, kMovedNormal);
  const std::vector<Vec3> fine_ridge = {{0, 0, 0}, {5e-6, 0, 5e-6}, {0, 1, 0}, {10e-6, 0, 0}};  // triangles within 10 um
  EXPECT_TRUE(coplanar_overlaps(scene_of({{fine_ridge, {{0, 1, 2}, {1, 3, 2}, {0, 2, 3}}}})).empty());
}

TEST(Coplanar, ABoxIsFreeOfThemUntilItStandsOnTheGround) {
  Soup box = both(rectangle(0, 0, 2, 1), rectangle(0, 0, 2, 1, 0.5));
  box.triangles.insert(box.triangles.end(),
                       {{0, 1, 5}, {0, 5, 4}, {1, 3, 7}, {1, 7, 5}, {3, 2, 6}, {3, 6, 7}, {2, 0, 4}, {2, 4, 6}});
  EXPECT_TRUE(coplanar_overlaps(scene_of({box}, random_place(1))).empty());
  const auto standing = coplanar_overlaps(scene_of({rectangle(-5, -5, 10, 10), box}, random_place(2)));
  ASSERT_EQ(standing.size(), 1u);
  EXPECT_NEAR(standing[0].area, 2.0, kAreaShare);
  EXPECT_EQ(standing[0].num_triangles, 4);
}

TEST(Coplanar, SliversLieOnEachOtherToo) {
  const Soup slivers = {{{0, 0, 0}, {1, 0, 0}, {0.4, 3e-6, 0}}, {{0, 1, 2}}};
  EXPECT_NEAR(area_between(slivers, slivers, random_place(3)), 1.5e-6, kRounding);
  EXPECT_EQ(area_between(slivers, {{{0, 0, 0}, {1, 0, 0}, {0.4, -3e-6, 0}}, {{0, 2, 1}}}, random_place(3)), 0.0);
}

// Pairs of k copies are k^2 / 2; the report names each copy once and other meshes with the first alone.
TEST(Coplanar, CopiesAtOnePlaceAreListedWithTheFirstOfThemAlone) {
  constexpr uint32_t kCopies = 300;
  // on itself by .5 m^2
  const Soup square = rectangle(0, 0, 1, 1, 0, 4), bent = both(square, rectangle(0.5, 0, 1, 1, 4e-6));
  const Transform place = random_place(7, kUtm);
  Scene scene = scene_of({rectangle(0, 0, 1, 0.25, -3e-6)}, place);
  for (uint32_t k = 0; k < kCopies; ++k) add(scene, bent, place);
  add(scene, square, random_place(8));  // of the same shape elsewhere
  const auto found = coplanar_overlaps(scene);
  ASSERT_EQ(found.size(), 1 + 1 + (kCopies - 1));
  const auto is_between = [](const CoplanarOverlap& one, uint32_t first, uint32_t second) {
    return one.first_mesh_id == first && one.second_mesh_id == second;
  };
  EXPECT_TRUE(is_between(found[0], 0, 1));
  EXPECT_TRUE(is_between(found[1], 1, 1));
  const auto two = coplanar_overlaps(scene_of({bent, turned_over(bent)}, place));  // no copies to the bit
  for (uint32_t k = 2; k <= kCopies; ++k) {
    EXPECT_TRUE(is_between(found[k], 1, k));
    EXPECT_NEAR(found[k].area, two[1].area, kAreaShare);
    EXPECT_NEAR(found[k].distance, two[1].distance, kDistance);
    EXPECT_EQ(found[k].num_triangles, two[1].num_triangles);
  }
}

// The tree of boxes leaves nothing out: pairs of a crowd are those of its triangles two by two.
TEST(Coplanar, ACrowdHasThePairsOfItsTrianglesTwoByTwo) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> in_square(0.0, 1.0);
  std::vector<Soup> crowd;
  for (int k = 0; k < 90; ++k) {
    const double size = k % 9 == 0 ? 1.0 : 0.2, x = in_square(random), y = in_square(random), z = 8e-6 * (k % 4);
    const auto corner = [&] { return Vec3(x + size * in_square(random), y + size * in_square(random), z); };
    crowd.push_back({{corner(), corner(), corner()}, {{0, 1, 2}}});
  }
  const Transform place = random_place(6);
  const auto found = coplanar_overlaps(scene_of(crowd, place));
  size_t num_pairs = 0;
  for (uint32_t a = 0; a < crowd.size(); ++a) {
    for (uint32_t b = a + 1; b < crowd.size(); ++b) {
      const double area = area_between(crowd[a], crowd[b], place);
      if (area == 0.0) continue;
      ASSERT_LT(num_pairs, found.size());
      EXPECT_EQ(found[num_pairs].first_mesh_id, a);
      EXPECT_EQ(found[num_pairs].second_mesh_id, b);
      EXPECT_NEAR(found[num_pairs].area, area, kMovedNormal);
      ++num_pairs;
    }
  }
  EXPECT_EQ(num_pairs, found.size());
  EXPECT_GT(num_pairs, 100u);
}

TEST(Coplanar, HoldsAtItsTimeOnly) {
  Scene scene = scene_of({rectangle(0, 0, 1, 1)});
  add(scene, rectangle(0, 0, 1, 1), Transform::Identity(), std::make_shared<const LinearMotion>(Vec3(0.5, 0.0, 0.0)));
  EXPECT_NEAR(coplanar_overlaps(scene, 0.0)[0].area, 1.0, kRounding);
  EXPECT_NEAR(coplanar_overlaps(scene, 1.0)[0].area, 0.5, kRounding);
  EXPECT_TRUE(coplanar_overlaps(scene, 2.0).empty());
}

TEST(Coplanar, DoesNotDependOnTheNumberOfThreads) {
  const Scene scene = scene_of({rectangle(0, 0, 1, 1, 0, 60), rectangle(0.1, 0.2, 1, 1, 3e-6, 41)}, random_place(4));
  const auto overlap = [&] {
    const auto found = coplanar_overlaps(scene);
    EXPECT_EQ(found.size(), 1u);
    return std::tuple(found.at(0).area, found.at(0).distance, found.at(0).num_triangles);
  };
  test::same_on_any_threads(overlap, {2, 3, 7});
}

TEST(Coplanar, EmptySceneAndBadInput) {
  EXPECT_TRUE(coplanar_overlaps(Scene()).empty());
  const Scene scene = scene_of({rectangle(0, 0, 1, 1)});
  EXPECT_TRUE(coplanar_overlaps(scene).empty());
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    expect_error<Invalid>([&] { coplanar_overlaps(scene, 0.0, bad); }, {"max_distance", "positive"});
  }
  Job job;
  job.cancel();
  EXPECT_THROW(coplanar_overlaps(scene, 0.0, kCoplanarDistance, &job), Cancelled);
}

// Building the tree of ten million triangles takes seconds.
TEST(Coplanar, TreesHearCancellation) {
  Job job;
  job.cancel();
  const auto unit_box = [](uint32_t) { return Box(Vec3::Zero(), Vec3::Ones()); };
  EXPECT_THROW(BoxTree(100'000, unit_box, 4, &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_coplanar
