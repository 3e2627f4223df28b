// Shares of rays that depend little on other objects: their sum, their proportions, and how many change with the scene.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "echopath/trace/launch/rays_by_object.h"
#include "echopath/trace/scatter/scatter_points.h"

namespace echopath::test_rays_by_object {
namespace {

constexpr double kFieldShare = 0.15;
constexpr int64_t kNumRays = 100000;

struct Plan {
  Scene scene;
  std::vector<RayTarget> targets;

  void add(const std::string& name, int num_mirrors) {
    if (!scene.find(name)) {
      Node node;
      node.name = name;
      scene.add(node);
    }
    RayTarget& target = targets.emplace_back();
    target.stratum.name = name + " over " + std::to_string(num_mirrors);
    target.stratum.object = *scene.find(name);
    target.stratum.num_mirrors = num_mirrors;
    target.weight = weight_of_target(num_mirrors);
  }
  std::vector<int64_t> rays(bool field_owns_any = true, int64_t num_rays = kNumRays) const {
    return rays_by_object(scene, targets, field_owns_any, kFieldShare, num_rays);
  }
};

Plan plan_of(int num_objects) {
  Plan plan;
  for (int k = 0; k < num_objects; ++k) plan.add("object_" + std::to_string(k), 0);
  return plan;
}

int64_t sum_of(const std::vector<int64_t>& rays) { return std::accumulate(rays.begin(), rays.end(), int64_t{0}); }

TEST(RaysByObject, AddUpToAboutWhatIsAskedFor) {
  const double most = std::exp2(0.25) + 1e-3;  // half a step of the root of two
  for (const int count : {1, 2, 3, 10, 40, 300}) {
    for (const bool field_owns_any : {false, true}) {
      const auto ratio = static_cast<double>(sum_of(plan_of(count).rays(field_owns_any))) / kNumRays;
      EXPECT_LT(ratio, most) << count;
      EXPECT_GT(ratio, 1.0 / most) << count;
    }
  }
  const auto of_many = static_cast<double>(sum_of(plan_of(300).rays())) / kNumRays;
  EXPECT_NEAR(of_many, 1.0, 0.03);
}

TEST(RaysByObject, GiveTheFieldOfViewItsShareWhereItOwnsAnything) {
  EXPECT_EQ(plan_of(5).rays(true).back(), std::llround(kFieldShare * kNumRays));
  EXPECT_EQ(plan_of(5).rays(false).back(), 0);
  EXPECT_EQ(plan_of(0).rays(false), std::vector<int64_t>{kNumRays});
  EXPECT_EQ(plan_of(2).rays(false, 1), (std::vector<int64_t>{0, 0, 1}));  // too few for either
}

TEST(RaysByObject, LeaveToTheFieldOfViewWhatIsTooLittleForATarget) {
  for (const auto& [num_objects, num_rays] : {std::pair(700, int64_t{4096}), {2400, 4096}, {300, 1000}}) {
    const std::vector<int64_t> rays = plan_of(num_objects).rays(true, num_rays);
    const double ratio = static_cast<double>(sum_of(rays)) / static_cast<double>(num_rays);
    EXPECT_NEAR(ratio, 1.0, 0.2) << num_objects;
    for (size_t k = 0; k + 1 < rays.size(); ++k) EXPECT_TRUE(rays[k] == 0 || rays[k] >= 4);
  }
}

TEST(RaysByObject, ImagesOverTwoMirrorsGetAQuarterOfTheirObject) {
  Plan plan = plan_of(7);
  plan.add("object_3", 1);
  plan.add("object_3", 2);
  const std::vector<int64_t> rays = plan.rays();
  EXPECT_EQ(rays[7], rays[3]);
  EXPECT_NEAR(static_cast<double>(rays[8]), 0.25 * static_cast<double>(rays[3]), 1.0);
}

// By logarithms of the sum of weights: log2(21/20) over half an octave, of all on the mean.
TEST(RaysByObject, OneMoreObjectChangesFewOthers) {
  double share = 0.0;
  constexpr int kFrom = 20, kTo = 60;
  for (int count = kFrom; count < kTo; ++count) {
    const std::vector<int64_t> before = plan_of(count).rays(), after = plan_of(count + 1).rays();
    int num_changed = 0;
    for (size_t k = 0; k < static_cast<size_t>(count); ++k) num_changed += before[k] != after[k];
    share += static_cast<double>(num_changed) / count / (kTo - kFrom);
  }
  EXPECT_NEAR(share, std::log2(static_cast<double>(kTo) / kFrom) / 0.5 / (kTo - kFrom), 0.02);
}

TEST(RaysByObject, StrataHaveNumbersOfTheirOwn) {
  std::set<int64_t> numbers;
  for (int k = 0; k < 1000; ++k) {
    const int64_t number = first_number_of("object_" + std::to_string(k));
    EXPECT_EQ(number % kScatterNetSize, 0);
    EXPECT_GE(number, 0);
    EXPECT_LT(number, int64_t{1} << 62);
    numbers.insert(number >> 34);  // more than the rays of a stratum
  }
  EXPECT_EQ(numbers.size(), 1000u);
}

}  // namespace
}  // namespace echopath::test_rays_by_object
