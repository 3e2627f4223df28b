#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "echopath/sim/rays/ray_allocation.h"

namespace echopath::test_ray_allocation {
namespace {

constexpr double kRounding = 1e-9;  // rays

RayNeed need(const std::string& name, double rays, bool is_image = false, bool is_bounded = true) {
  RayNeed out;
  out.stratum = name;
  out.rays = rays;
  out.is_image = is_image;
  out.is_bounded = is_bounded;
  return out;
}

double sum_of(const RayShares& shares) {
  double sum = 0.0;
  for (const auto& [name, share] : shares) sum += share;
  return sum;
}

TEST(ShareOut, GivesEachWhatItNeedsWhereRaysSuffice) {
  const RayNeeds needs{{need("pole", 10), need("car", 300), need("car over wall", 200, true)}};
  const RayShares shares = share_out(needs, 1000.0);
  EXPECT_EQ(shares, (RayShares{{"pole", 10.0}, {"car", 300.0}, {"car over wall", 200.0}}));
}

// Of 100 rays three needs of 60 together can be met in full; the fourth could not be met with all of them.
TEST(ShareOut, MeetsAsManyNeedsAsItCan) {
  const RayNeeds needs{{need("large", 1000), need("c", 30), need("a", 10), need("b", 20)}};
  const RayShares shares = share_out(needs, 100.0);
  EXPECT_EQ(shares, (RayShares{{"a", 10.0}, {"b", 20.0}, {"c", 30.0}, {"large", 40.0}}));
}

TEST(ShareOut, LeavesAQuarterToWhatMayNeedAnyNumber) {
  const RayNeeds needs{{need("a", 40), need("b", 60), need("any", 3200, false, false)}};
  const RayShares shares = share_out(needs, 100.0);
  EXPECT_DOUBLE_EQ(shares.at("a"), 40.0);  // b would leave less than a quarter
  EXPECT_DOUBLE_EQ(shares.at("b"), 30.0);
  EXPECT_DOUBLE_EQ(shares.at("any"), 30.0);
}

TEST(ShareOut, ServesObjectsBeforeImagesAndAddsUp) {
  const RayNeeds needs{
      {need("car", 900), need("pole", 100), need("car over wall", 2000, true), need("pole over wall", 50, true)}};
  const RayShares shares = share_out(needs, 1000.0);
  EXPECT_NEAR(sum_of(shares), 1000.0, kRounding);
  EXPECT_DOUBLE_EQ(shares.at("pole"), 100.0);
  EXPECT_DOUBLE_EQ(shares.at("pole over wall"), 50.0);
  EXPECT_GT(shares.at("car") + shares.at("pole"), 500.0);
  EXPECT_LT(shares.at("car over wall"), 500.0);
}

}  // namespace
}  // namespace echopath::test_ray_allocation
