// Traces that leave out faint paths while the record is made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "cpp/support/scenes.h"
#include "echopath/power/faint_paths.h"
#include "echopath/power/path_power.h"
#include "echopath/sim/rays/thinned_trace.h"

namespace echopath::test_thinned_trace {
namespace {

MaterialPtr mirror() {
  Material material = *testing::lambert(0.5);
  material.scattering = 0.3;
  material.mirror = true;
  return testing::share(material);
}

MaterialPtr pane() {
  Material material;
  material.layers = {{0.004, {6.0, 0.0}}};
  return testing::share(material);
}

// Returns a street between two walls with a rough plate, a metal ball, and a pane before both.
Scene street() {
  Scene scene;
  testing::add_rectangle(scene, "floor", {0, -3, -1}, {40, 0, 0}, {0, 6, 0}, mirror());
  testing::add_rectangle(scene, "left", {0, 3, -1}, {40, 0, 0}, {0, 0, 4}, mirror());
  testing::add_rectangle(scene, "right", {0, -3, -1}, {0, 0, 4}, {40, 0, 0}, mirror());
  testing::add_rectangle(scene, "plate", {9, 1, -0.5}, {0, -1, 0}, {0, 0, 1}, testing::lambert(0.8));
  testing::add_rectangle(scene, "pane", {5, 2, -0.8}, {0, -3, 0}, {0, 0, 2}, pane());
  testing::add_smooth_ball(scene, "ball", {8, -1.5, 0.2}, 0.4, 3);
  return scene;
}

// Hits and passes have no paddings.
template <class T>
bool is_same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(ThinnedTrace, LeavesWhatThinningTheWholeRecordLeaves) {
  const Scene scene = street();
  const Radar radar = testing::plain_radar({0, 0, 0}, {0, 0.01, 0});
  TraceSettings settings;
  settings.num_rays = 16000;
  settings.polarization = PolarizationModel::kJones;
  const Paths all = trace(scene, radar, settings);
  ASSERT_GT(all.num_paths(), 1 << 18);  // several parts
  ASSERT_FALSE(all.passes.empty() || all.curved_cell.empty() || all.jones.empty());
  std::vector<double> power = path_power(all);
  std::ranges::nth_element(power, power.begin() + all.num_paths() / 2);
  settings.faint_power = 10.0 * power[static_cast<size_t>(all.num_paths()) / 2];
  const Paths expected = thinned(trace(scene, radar, settings)),
              found = thinned_trace(scene, radar, settings, nullptr, nullptr);
  EXPECT_LT(expected.num_paths(), all.num_paths() * 3 / 4);
  for_each_column([&](auto column) { EXPECT_EQ(found.*column, expected.*column); });
  EXPECT_EQ(found.jones, expected.jones);
  EXPECT_EQ(found.curved_cell, expected.curved_cell);
  EXPECT_EQ(found.pass_offsets, expected.pass_offsets);
  EXPECT_TRUE(is_same(found.passes, expected.passes));
  EXPECT_TRUE(is_same(*found.hits, *expected.hits));
  const TraceStatistics &told = found.frame.statistics, &right = expected.frame.statistics;
  EXPECT_EQ(told.num_rays, settings.num_rays);
  EXPECT_EQ(told.num_paths, right.num_paths);
  EXPECT_EQ(told.num_faint_paths, right.num_faint_paths);
  EXPECT_EQ(told.num_queries, right.num_queries);
  EXPECT_EQ(told.num_hits, right.num_hits);
}

}  // namespace
}  // namespace echopath::test_thinned_trace
