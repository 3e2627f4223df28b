#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "cpp/support/scenes.h"
#include "echopath/power/received_power.h"
#include "echopath/radar/noise_power.h"
#include "echopath/sim/rays/ray_allocation.h"

namespace echopath::test_ray_allocation {
namespace {

constexpr double kRounding = 1e-9;  // rays, or relative

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

// Seven needs of 10 are served, p is the first that three quarters of the rays do not reach. Half of the 30 rays that are
// left would be 4 more than it asks.
TEST(ShareOut, GivesNoBoundedNeedMoreThanItAsks) {
  RayNeeds needs{{need("p", 11), need("any", 3200, false, false)}};
  for (int i = 0; i < 7; ++i) needs.strata.push_back(need("small " + std::to_string(i), 10));
  const RayShares shares = share_out(needs, 100.0);
  EXPECT_DOUBLE_EQ(shares.at("p"), 11.0);
  EXPECT_DOUBLE_EQ(shares.at("any"), 19.0);
}

// Of 70 rays that are left, 6 parts of 9 would be 46.7. What it does not ask goes to the others, two parts to one.
TEST(ShareOut, SharesAgainByWeightWhatANeedLeaves) {
  RayNeeds needs{{need("served", 30), need("met", 46), need("lacks", 50), need("any", 3200, false, false)}};
  needs.strata[1].weight = 6.0;
  needs.strata[2].weight = 2.0;
  const RayShares shares = share_out(needs, 100.0);
  EXPECT_EQ(shares, (RayShares{{"served", 30.0}, {"met", 46.0}, {"lacks", 16.0}, {"any", 8.0}}));
}

// A need without bounds asks for as many as a pilot may foretell, and may need any number more.
TEST(ShareOut, GivesTheShareOfItsWeightToWhatMayNeedAnyNumberHoweverLittleItAsks) {
  RayNeeds needs{{need("weak", 100, false, false), need("strong", 2000, false, false)}};
  needs.strata[0].weight = 3.0;
  EXPECT_EQ(share_out(needs, 1000.0), (RayShares{{"weak", 750.0}, {"strong", 250.0}}));
}

// Over random needs and weights, too many for their rays.
TEST(ShareOut, NoBoundedNeedGetsMoreThanItAsksWhileAnotherLacks) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> magnitude(0.0, 3.0), weight(0.1, 2.0);
  for (int trial = 0; trial < 300; ++trial) {
    RayNeeds needs;
    for (int i = 0; i < 12; ++i) {
      needs.strata.push_back(need(std::to_string(i), std::pow(10.0, magnitude(random)), i % 2 == 0, i % 5 != 0));
      needs.strata.back().weight = weight(random);
    }
    const double num_rays = 0.9 * needs.num_rays();
    const RayShares shares = share_out(needs, num_rays);
    EXPECT_NEAR(sum_of(shares), num_rays, kRounding * num_rays);
    for (const RayNeed& one : needs.strata) {
      if (one.is_bounded) {
        EXPECT_LE(shares.at(one.stratum), one.rays * (1.0 + kRounding)) << trial << " " << one.stratum;
      }
    }
  }
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

// Of 1000 rays needs take 400, and half of the others go to the cells of "ground": 300, beside its part of the 700.
TEST(ShareOut, GivesCellsHalfOfWhatNeedsLeave) {
  RayNeeds needs{{need("ground", 100), need("car", 300)}};
  needs.strata[0].more_for_cells = 1000.0;
  const RayShares shares = share_out(needs, 1000.0);
  EXPECT_NEAR(shares.at("ground") / sum_of(shares), (300.0 + 700.0 * 0.25) / 1000.0, kRounding);
  needs.strata[0].more_for_cells = 30.0;  // all that it asks for
  EXPECT_NEAR(share_out(needs, 1000.0).at("ground") / sum_of(share_out(needs, 1000.0)), (30.0 + 970.0 * 0.25) / 1000.0,
              kRounding);
}

TEST(ShareOut, GivesCellsASeventhWhereRaysAreTooFew) {
  RayNeeds needs{{need("ground", 500), need("car", 1500)}};
  needs.strata[0].more_for_cells = needs.strata[1].more_for_cells = 4000.0;
  RayNeeds alone = needs;
  for (RayNeed& one : alone.strata) one.more_for_cells = 0.0;
  const RayShares shares = share_out(needs, 1000.0), of_needs = share_out(alone, 850.0);
  EXPECT_NEAR(sum_of(shares), 1000.0, kRounding);
  for (const auto& [name, share] : shares) EXPECT_NEAR(share, of_needs.at(name) + 75.0, kRounding) << name;
}

// A metal ball at rest, a rough plate that moves, and a small plate far away, whose echo is weak.
Paths three_echoes() {
  Scene scene;
  testing::add_smooth_ball(scene, "ball", {10, 0, 0}, 0.1, 3);
  testing::add_rectangle(scene, "car", {8, 2, -0.5}, {0, 1, 0}, {0, 0, 1}, testing::lambert(0.5));
  Node car = scene.nodes()[1];
  car.motion = std::make_shared<const LinearMotion>(Vec3(5.0, 0.0, 0.0));
  scene.change(1, std::move(car));
  testing::add_rectangle(scene, "far", {300, -5, 0}, {0, 0.3, 0}, {0, 0, 0.3}, testing::lambert(0.01));
  return trace(scene, testing::plain_radar(Vec3::Zero(), Vec3::Zero()), testing::with_rays(3000));
}

ReceivedPower power_of_stratum(const Paths& paths, size_t stratum) {
  std::vector<uint8_t> keep;
  for (const auto of_path : paths.stratum) keep.push_back(of_path == stratum);
  return received_power(paths.select(keep));
}

// The law as it is written down: rays in proportion to the error over the target, which is a quarter for what moves; within
// a factor, and a quarter of them for what sends nothing back. The field of view keeps its rays.
TEST(RayNeeds, FollowFromTheIntervalOfEachEcho) {
  const Paths paths = three_echoes();
  const RayShares launched = shares_of(paths.frame.strata);
  const std::vector<WantedError> all = {{.db = 0.3},
                                        {.db = 0.05, .law = RayLaw::kByPower},
                                        {.db = 3.0, .least_growth = 1.0},
                                        {.db = 0.3, .least_power = 1e-2 * received_power(paths).power},
                                        {.db = 2.0, .floor = EchoFloor::kNoise, .law = RayLaw::kByPower}};
  int num_above = 0, num_below = 0;
  for (const WantedError& wanted : all) {
    const RayNeeds needs = ray_needs(paths, wanted);
    double strongest = 0.0, worst = 0.0;
    for (size_t k = 0; k < paths.frame.strata.size(); ++k) strongest = std::max(strongest, power_of_stratum(paths, k).power);
    const double floor = wanted.floor == EchoFloor::kNoise ? noise_power_in_cell(paths.radar) : 1e-6 * strongest;
    const double least = std::max(floor, wanted.least_power);
    ASSERT_EQ(needs.strata.size(), paths.frame.strata.size());
    for (size_t k = 0; k < needs.strata.size(); ++k) {
      const Stratum& stratum = paths.frame.strata[k];
      const RayNeed& found = needs.strata[k];
      const ReceivedPower power = power_of_stratum(paths, k);
      const double half = std::max(power.high_of_rays - power.power, power.power - power.low_of_rays);
      const double missing = 10.0 * std::log10(1.0 + half / std::max(power.power, least));
      const double target = wanted.db * (stratum.name == "car" ? 0.25 : 1.0);
      const auto relative = [](double db) { return std::pow(10.0, 0.1 * db) - 1.0; };
      double growth = wanted.law == RayLaw::kByDecibels ? missing / target : relative(missing) / relative(target);
      growth = std::clamp(growth, wanted.least_growth, 32.0);
      if (power.high_of_rays == 0.0) growth = std::max(0.25, wanted.least_growth);
      if (stratum.object < 0) growth = 1.0;
      EXPECT_EQ(found.stratum, stratum.name);
      EXPECT_NEAR(found.rays, growth * launched.at(stratum.name), kRounding * found.rays) << stratum.name;
      EXPECT_EQ(found.is_bounded, growth < 32.0) << stratum.name;
      EXPECT_EQ(found.is_resolved, missing <= target || power.high_of_rays <= least) << stratum.name;
      EXPECT_NEAR(found.echo.high, power.high_of_rays, kRounding * power.high_of_rays);
      EXPECT_FALSE(found.is_image);
      if (power.high_of_rays > least) worst = std::max(worst, missing);
      (power.high_of_rays > least ? num_above : num_below) += 1;
    }
    EXPECT_NEAR(needs.worst_db, worst, kRounding);
  }
  EXPECT_GT(num_above, 5);
  EXPECT_GT(num_below, 2);
}

// Needs of two machines differ in their last bits, or by a path or two of thousands.
TEST(RoundedRays, HardlyEverTellPilotsOfTwoMachinesApart) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> of_exponent(0.0, 7.0);
  int num_apart = 0;
  constexpr int kTrials = 1000;
  constexpr double kApart = 2e-5, kCoarsest = 1.0 / 64.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double rays = std::pow(10.0, of_exponent(random)), rounded = rounded_rays(rays);
    EXPECT_NEAR(rounded, rays, kCoarsest * rays);
    EXPECT_EQ(rounded_rays(rounded), rounded);
    if (rounded_rays(rays * (1.0 + kApart)) != rounded) ++num_apart;
  }
  EXPECT_LE(num_apart, 4);  // 2e-5 of steps of 1/64 to 1/32: one of them expected
  EXPECT_EQ(rounded_rays(0.0), 0.0);
}

}  // namespace
}  // namespace echopath::test_ray_allocation
