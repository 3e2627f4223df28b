// What paths of a scene share: legs, points, the evaluation of single bounces.
#include <gtest/gtest.h>

#include "cpp/replay/legs/all_kinds_of_paths.h"
#include "cpp/replay/small_arrays.h"
#include "echopath/replay/evaluate/shared_leg_plan.h"
#include "echopath/replay/posed/touched_meshes.h"

namespace echopath::test_shared_leg_plan {
namespace {

using namespace testing;

struct SingleBounceCounts {
  size_t paths = 0, pairs = 0, others = 0;
  std::vector<int> of_mesh;
};

SingleBounceCounts single_bounce_counts(const Paths& paths) {
  const PathPreparer preparer(paths, touched_meshes(paths));
  SharedLegPlanner planner;
  planner.begin(paths, preparer, SpecularPoints::kMaterial, true);
  const SharedLegPlan& plan = planner(all_of(paths));
  SingleBounceCounts counts;
  counts.others = plan.chains.size() + plan.mirror_paths.size();
  counts.of_mesh.resize(paths.scene->meshes().size());
  for (const SharedLegPlan::SingleBounce& point : plan.single_bounces) {
    const auto has = [&](size_t kind) { return size_t{point.path[kind] != SharedLegPlan::SingleBounce::kNoPath}; };
    counts.paths += has(0) + has(1);
    counts.pairs += has(0) & has(1);
    ++counts.of_mesh[point.hit->mesh_id];
  }
  return counts;
}

TEST(SharedLegPlan, PolarizedPathsAreSharedAsScalarOnes) {
  const Paths scalar = record(array_of_powers()), polarized = record(array_of_powers(), true, PolarizationModel::kJones);
  ASSERT_EQ(scalar.num_paths(), polarized.num_paths());
  EXPECT_EQ(scalar.hits->size(), polarized.hits->size());
  EXPECT_EQ(single_bounce_counts(scalar).paths, single_bounce_counts(polarized).paths);
  EXPECT_EQ(single_bounce_counts(scalar).others, single_bounce_counts(polarized).others);
}

TEST(SharedLegPlan, PathsOfOnePointStandApart) {
  const Paths over_mirrors = record(array_of_powers()), paths = record(array_of_powers(), false);
  for (const Paths* some : {&over_mirrors, &paths}) {
    const SingleBounceCounts counts = single_bounce_counts(*some);
    EXPECT_EQ(counts.paths + counts.others, static_cast<size_t>(some->num_paths()));
    EXPECT_GT(counts.of_mesh[0] + counts.of_mesh[1] + counts.of_mesh[2], 20);  // walls, ground
    EXPECT_GT(counts.of_mesh[3], 8);
    EXPECT_EQ(counts.of_mesh[4], 0);  // smooth
    EXPECT_EQ(counts.of_mesh[5], 0);  // stretched along its way
    EXPECT_GT(counts.of_mesh[6], 3);
  }
  EXPECT_GT(single_bounce_counts(paths).pairs, 100u);
}

// The scene has all kinds of paths that the first test is about, and they do share.
TEST(SharedLegPlan, RaysShareLegsAndPoints) {
  const Radar radar = array();
  const Paths paths = record(radar);
  const std::vector<int64_t> indices = all_of(paths);
  const PathPreparer preparer(paths, touched_meshes(paths));
  SharedLegPlanner planner;
  planner.begin(paths, preparer, SpecularPoints::kMaterial, false);
  const SharedLegPlan& plan = planner(indices);
  EXPECT_EQ(plan.chains.size() + plan.mirror_paths.size(), indices.size());
  EXPECT_GT(plan.mirror_paths.size(), 2u);
  EXPECT_LT(plan.legs.size(), plan.chains.size());  // each has two
  EXPECT_LT(plan.points.size(), plan.legs.size());
  const auto any_chain = [&](auto is) { return std::any_of(plan.chains.begin(), plan.chains.end(), is); };
  EXPECT_TRUE(any_chain([](const SharedLegPlan::ChainPath& chain) { return chain.is_reversed; }));
  EXPECT_TRUE(any_chain([](const SharedLegPlan::ChainPath& chain) { return chain.inner == SharedLegPlan::kNone; }));
  EXPECT_TRUE(any_chain([&](const SharedLegPlan::ChainPath& chain) {
    return chain.inner != SharedLegPlan::kNone && (plan.inner[chain.inner].diffuse & 1) == 0;
  }));
  EXPECT_TRUE(
      any_chain([&](const SharedLegPlan::ChainPath& chain) { return plan.images[plan.legs[chain.end].image].parent != 0; }));
  EXPECT_GT(plan.inner.size(), 10u);
}

}  // namespace
}  // namespace echopath::test_shared_leg_plan
