// How rays are shared out among strata, against the rule of LaunchPlan and the shares of guides.
#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/trace/launch/launch_shares.h"

namespace echopath::test_launch_shares {
namespace {

using Rays = std::vector<int64_t>;
const std::string kField = "field of view";

struct Launch {
  RayTargets found;
  FieldOwns field{true, true};
  LaunchSettings settings;

  explicit Launch(int64_t num_rays) { settings.num_rays = num_rays; }
  Launch& aim(const std::string& name, bool moves = false, double weight = 1.0) {
    RayTarget& target = found.targets.emplace_back();
    target.stratum.name = name;
    target.moves = moves;
    target.weight = weight;
    ++found.num_objects;
    return *this;
  }
  Rays rays() const { return LaunchShares(Scene(), found, field, settings).rays({}, kField); }
};

int64_t sum_of(const Rays& rays) { return std::accumulate(rays.begin(), rays.end(), int64_t{0}); }

TEST(LaunchShares, WhatMovesHasHalfOfTheAimedRays) {
  EXPECT_EQ(Launch(8000).aim("a").aim("b").aim("c", true).rays(), (Rays{1700, 1700, 3400, 1200}));
  EXPECT_EQ(Launch(8000).aim("a").aim("b", true).aim("c", true).aim("d", true).rays(), (Rays{1700, 1700, 1700, 1700, 1200}));
}

TEST(LaunchShares, TooFewRaysForATargetFallToTheFieldOfView) {
  EXPECT_EQ(Launch(10).aim("a").aim("b").aim("c").rays(), (Rays{0, 0, 0, 10}));
  Launch by_name(6);
  by_name.settings.by_name = true;
  by_name.field.any = false;
  EXPECT_EQ(by_name.aim("a").aim("b").rays(), (Rays{0, 0, 6}));
}

TEST(LaunchShares, RemaindersGoToTheTargetWithTheMostRays) {
  Launch launch(100);
  launch.settings.by_name = true;
  launch.field.any = false;
  EXPECT_EQ(launch.aim("a", false, 0.25).aim("b").aim("c").rays(), (Rays{11, 45, 44, 0}));
}

// Half of the aimed rays, or half of all where the field of view serves what moves alone.
TEST(LaunchShares, SteadyRaysOfWhatStandsStillDoNotDependOnWhatMoves) {
  for (const bool field_is_still : {true, false}) {
    Launch still(10000);
    still.settings.is_steady = still.settings.by_name = true;
    still.field.still = field_is_still;
    Launch both = still.aim("a").aim("b");
    both.aim("c", true).aim("d", true);
    const int64_t expected = field_is_still ? 2125 : 2500;
    for (const Launch& launch : {still, both}) {
      EXPECT_EQ(launch.rays()[0], expected);
      EXPECT_EQ(launch.rays()[1], expected);
    }
    EXPECT_EQ(sum_of(both.rays()), 10000);
    EXPECT_EQ(both.rays()[2], both.rays()[3]);
  }
}

TEST(LaunchShares, WhatAGuideDoesNotNameHasItsMean) {
  Launch launch(600);
  launch.settings.guide.shares = {{"a", 100.0}, {kField, 300.0}};
  EXPECT_EQ(launch.aim("a").aim("b").rays(), (Rays{100, 200, 300}));
}

// Guides by name count rays: others that stand still share those of the field of view, others that move what is left over.
TEST(LaunchShares, WhatAGuideByNameDoesNotNameTakesFromItsFieldOfView) {
  Launch launch(300);
  launch.settings.by_name = true;
  launch.settings.guide.shares = {{"a", 100.0}, {kField, 100.0}};
  EXPECT_EQ(launch.aim("a").aim("b").rays(), (Rays{100, 50, 50}));
  EXPECT_EQ(launch.aim("c", true).aim("d", true).rays(), (Rays{100, 50, 50, 50, 50}));
}

// The rays of a focus are its owner's. What stands still has half of the rays of which the densities are.
TEST(LaunchShares, SteadyDefaultDensitiesAreThoseOfWhatStandsStill) {
  Launch launch(1000);
  launch.settings.is_steady = launch.settings.by_name = true;
  launch.field.still = false;
  launch.aim("a");
  Stratum owner, focus, field;
  owner.num_rays = 300;
  focus.num_rays = 125;
  focus.focus_of = 0;
  const std::vector<double> found =
      LaunchShares(Scene(), launch.found, launch.field, launch.settings).default_densities({owner, focus, field});
  EXPECT_DOUBLE_EQ(found[0], 425.0 / (4.0 * kPi));
  EXPECT_DOUBLE_EQ(found[2], 0.15 * 850.0 / (4.0 * kPi));  // of twice what stands still has
}

}  // namespace
}  // namespace echopath::test_launch_shares
