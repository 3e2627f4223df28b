// Which paths of a record are checked, and for how many each of them stands.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "cpp/support/scenes.h"
#include "echopath/validity/frame/path_sample.h"

namespace echopath::test_path_sample {
namespace {

using namespace testing;

constexpr int64_t kPrime = 40009;  // of paths, which no step divides

TEST(PathSample, StandsForEachPathOnce) {
  Scene scene;
  add_rectangle(scene, "plate", {8, -1, -1}, {0, 2, 0}, {0, 0, 2}, lambert(0.3));
  const Paths traced = trace(scene, plain_radar({0, 0, 0}, {0, 0, 0}), with_rays(50000, 1));
  ASSERT_GT(traced.num_paths(), kPrime);
  std::vector<uint8_t> keep(static_cast<size_t>(traced.num_paths()));
  std::fill_n(keep.begin(), kPrime, uint8_t{1});
  const Paths paths = traced.select(keep);
  const PathSample sample = sample_of(paths, false);
  EXPECT_LT(2 * std::ssize(sample.paths), kPrime);
  EXPECT_EQ(std::accumulate(sample.weights.begin(), sample.weights.end(), 0.0), kPrime);
}

}  // namespace
}  // namespace echopath::test_path_sample
