// Two records without what they have in common: paths count as often as they stand there.
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"
#include "echopath/trace/live/path_difference.h"

namespace echopath::test_path_difference {
namespace {

using namespace testing;

constexpr uint32_t kStill = 0, kMoved = 1;

struct Bounce {
  uint32_t mesh_id;
  float u;
};

// A record of paths of one bounce each over two plates.
Paths record(const std::vector<Bounce>& bounces) {
  Scene scene;
  add_rectangle(scene, "still", {5, -1, -1}, {0, 2, 0}, {0, 0, 2}, lambert(0.5));
  add_rectangle(scene, "moved", {7, -1, -1}, {0, 2, 0}, {0, 0, 2}, lambert(0.5));
  Paths paths;
  std::vector<Hit> hits;
  for (const Bounce& bounce : bounces) {
    paths.offsets.push_back(std::ssize(hits));
    hits.emplace_back(bounce.mesh_id, 0u, bounce.u, 0.25f);
  }
  const size_t count = bounces.size();
  paths.hits = std::make_shared<const std::vector<Hit>>(std::move(hits));
  paths.num_bounces.assign(count, 1);
  paths.diffuse.assign(count, 1);
  paths.weight.assign(count, {1.0f, 0.0f});
  paths.stratum.assign(count, kNoStratum);
  paths.batch.assign(count, kNoBatch);
  paths.flags.assign(count, 0);
  paths.scene = std::make_shared<const Scene>(std::move(scene));
  return paths;
}

// Both scenes have the two meshes, of which some have changed.
CommonParts common(const ChangedMeshes& changed) { return {{{0, 1}, {0, 1}, changed, changed}, {}}; }

std::vector<float> places(const Paths& paths) {
  std::vector<float> us;
  for (int64_t path = 0; path < paths.num_paths(); ++path) us.push_back(paths.hits_of(path)->u);
  return us;
}

TEST(PathDifference, PathsOfBothRecordsAreLeftOutAsOftenAsBothHaveThem) {
  Paths before = record({{kStill, 0.1f}, {kStill, 0.2f}, {kStill, 0.1f}, {kStill, 0.3f}, {kStill, 0.1f}});
  Paths after = record({{kStill, 0.3f}, {kStill, 0.1f}, {kStill, 0.4f}, {kStill, 0.3f}, {kStill, 0.1f}});
  leave_out_common(before, after, common({false, false}));
  EXPECT_EQ(places(before), (std::vector{0.2f, 0.1f}));
  EXPECT_EQ(places(after), (std::vector{0.4f, 0.3f}));
}

TEST(PathDifference, PathsOverAChangedMeshAreLikeNoOther) {
  Paths before = record({{kMoved, 0.1f}, {kStill, 0.2f}}), after = record({{kStill, 0.2f}, {kMoved, 0.1f}});
  leave_out_common(before, after, common({false, true}));
  EXPECT_EQ(places(before), std::vector{0.1f});
  EXPECT_EQ(places(after), std::vector{0.1f});
}

// The still plate has the other's number after a third mesh has come before it; strata have moved up by one.
TEST(PathDifference, PathsAreTheSameWhateverTheNumbersOfTheirMeshesAndStrata) {
  Paths before = record({{kStill, 0.1f}, {kStill, 0.2f}, {kStill, 0.3f}});
  Paths after = record({{kMoved, 0.1f}, {kMoved, 0.2f}, {kMoved, 0.3f}});
  before.stratum = {0, 1, 0};
  after.stratum = {1, 2, 2};
  before.frame.strata.resize(2);
  after.frame.strata.resize(3);
  leave_out_common(before, after, {{{1, kNoMesh}, {kNoMesh, 0}, {false, true}, {true, false}}, {-1, 0, -1}});
  EXPECT_EQ(places(before), (std::vector{0.2f, 0.3f}));
  EXPECT_EQ(places(after), (std::vector{0.2f, 0.3f}));
}

TEST(PathDifference, RecordsWithoutPathsHaveNothingInCommon) {
  Paths before = record({}), after = record({{kStill, 0.2f}});
  leave_out_common(before, after, common({false, false}));
  EXPECT_EQ(before.num_paths(), 0);
  EXPECT_EQ(after.num_paths(), 1);
}

}  // namespace
}  // namespace echopath::test_path_difference
