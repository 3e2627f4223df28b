// What the queries of rays went through: a stretch meets a box where one of its points lies in it, and space is remembered
// up to what a query met.
#include <gtest/gtest.h>

#include <random>

#include "cpp/support/scenes.h"
#include "echopath/trace/live/queried_space.h"

namespace echopath::test_queried_space {
namespace {

using namespace testing;

constexpr double kClear = 1e-3;  // m: so near to a box's rim single precision may say either

// Returns whether the segment meets the box, in double precision, by cutting it slab by slab (Kay, Kajiya 1986).
bool meets_slowly(const Vec3& from, const Vec3& to, const Vec3& low, const Vec3& high) {
  double begin = 0.0, end = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    if (way == 0.0) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) return false;
      continue;
    }
    const double a = (low[axis] - from[axis]) / way, b = (high[axis] - from[axis]) / way;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

QueriedSpace::Point point(const Vec3& at) {
  const Eigen::Vector3f rounded = at.cast<float>();
  return {rounded.x(), rounded.y(), rounded.z()};
}

TEST(QueriedSpace, MeetsTheBoxesThatItsStretchesPassThrough) {
  std::mt19937_64 draw(7);
  std::uniform_real_distribution<double> place(-20.0, 20.0), size(0.05, 14.0);
  const auto any = [&] { return Vec3(place(draw), place(draw), place(draw)); };
  int num_met = 0, num_missed = 0;
  for (int round = 0; round < 40000; ++round) {
    const Vec3 from = any(), to = round % 7 == 0 ? Vec3(from.x(), from.y(), any().z()) : any();
    const Vec3 low = any(), high = low + Vec3(size(draw), size(draw), size(draw)), rim = Vec3::Constant(kClear);
    const bool surely = meets_slowly(from, to, low + rim, high - rim), maybe = meets_slowly(from, to, low - rim, high + rim);
    QueriedSpace space;
    space.add(point(from), point(to));
    const std::vector<FloatBox> boxes{FloatBox(low.cast<float>(), high.cast<float>())};
    EXPECT_TRUE(space.meets(boxes) ? maybe : !surely) << round;
    num_met += surely;
    num_missed += !maybe;
  }
  EXPECT_GT(num_met, 300);
  EXPECT_GT(num_missed, 10000);
}

TEST(QueriedSpace, EachOfManyStretchesCounts) {
  for (const int count : {1, 15, 16, 17, 40}) {
    QueriedSpace space;
    for (int k = 0; k < count; ++k) {
      const auto x = static_cast<float>(10 * k);
      space.add({x, 0.0f, 0.0f}, {x + 1.0f, 0.0f, 0.0f});
    }
    for (int k = 0; k <= count; ++k) {
      const Eigen::Vector3f middle(static_cast<float>(10 * k) + 0.5f, 0.0f, 0.0f), half(0.1f, 0.1f, 0.1f);
      const std::vector<FloatBox> boxes{FloatBox(middle - half, middle + half)};
      EXPECT_EQ(space.meets(boxes), k < count) << count << " " << k;
    }
    space.clear();
    EXPECT_FALSE(space.meets(std::vector<FloatBox>{FloatBox(Eigen::Vector3f(-1, -1, -1), Eigen::Vector3f(1e3f, 1, 1))}));
  }
}

// A plate at x = 10 between x = 0 and 20: a query for the closest hit ends there, one for a shadow counts as a whole.
TEST(QueryWatch, RemembersUpToTheHitAndShadowsAsAWhole) {
  Scene scene;
  add_rectangle(scene, "plate", {10, -5, -5}, {0, 10, 0}, {0, 0, 10}, lambert(0.5));
  const PosedScene pose(scene, 0.0);
  EmbreeScene geometry(scene, pose, Vec3::Zero());
  const std::vector<FloatBox> before{FloatBox(Eigen::Vector3f(5, -1, -1), Eigen::Vector3f(6, 1, 1))};
  const std::vector<FloatBox> behind{FloatBox(Eigen::Vector3f(15, -1, -1), Eigen::Vector3f(16, 1, 1))};
  QueriedSpace closest, shadow, miss;
  const QueryWatch watch(geometry);
  {
    const QueryWatch::OfThread watching(closest);
    RayHit hit;
    ASSERT_EQ(geometry.intersect(Vec3::Zero(), Vec3::UnitX(), hit), EmbreeScene::Verdict::kHit);
  }
  {
    const QueryWatch::OfThread watching(shadow);
    EXPECT_TRUE(geometry.occluded(Vec3::Zero(), Vec3(20, 0, 0)));
  }
  {
    const QueryWatch::OfThread watching(miss);
    RayHit hit;
    EXPECT_EQ(geometry.intersect(Vec3::Zero(), -Vec3::UnitX(), hit), EmbreeScene::Verdict::kMiss);
  }
  EXPECT_TRUE(closest.meets(before));
  EXPECT_FALSE(closest.meets(behind));
  EXPECT_TRUE(shadow.meets(before));
  EXPECT_TRUE(shadow.meets(behind));
  EXPECT_FALSE(miss.meets(before));
  EXPECT_TRUE(miss.meets(std::vector<FloatBox>{FloatBox(Eigen::Vector3f(-9, -1, -1), Eigen::Vector3f(-8, 1, 1))}));
}

}  // namespace
}  // namespace echopath::test_queried_space
