#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "cpp/label/hand_made_paths.h"
#include "cpp/support/any_threads.h"
#include "echopath/label/grouping.h"
#include "echopath/label/objects/families.h"

namespace echopath::test_families {
namespace {

using namespace testing;

// The walker is the object, the walls and the floor stand apart.
SurfaceMap walker_first() { return map_surfaces(*make_street(), {{"walker", {"pedestrian"}}, {"floor", {"street/floor"}}}); }

HandMadePath path_over(const std::vector<uint32_t>& meshes) {
  HandMadePath path;
  for (const uint32_t mesh : meshes) path.push_back({mesh, false});
  return path;
}

Family family_of(const std::vector<uint32_t>& meshes, const SurfaceMap& surfaces = walker_first()) {
  const Families found = find_families(make_paths({path_over(meshes)}), surfaces);
  return found.families[found.family_of_path.front()];
}

struct Known {
  std::vector<uint32_t> meshes;
  Family family;
  int class_code;
};

// Worked out by hand from the text of the dataset's labels (CMTO without the class).
const std::vector<Known> kKnown{
    {{kTorso}, {"walker", 0, 1, {}}, 111},
    {{kTorso, kArmLeft, kTorso}, {"walker", 0, 1, {}}, 111},
    {{kWallLeft, kTorso}, {"walker", 1, 2, {"street/wall_left"}}, 112},
    {{kWallLeft, kTorso, kArmLeft}, {"walker", 1, 2, {"street/wall_left"}}, 112},
    {{kTorso, kWallLeft}, {"walker", 2, 2, {"street/wall_left"}}, 122},
    {{kArmLeft, kTorso, kWallRight}, {"walker", 2, 2, {"street/wall_right"}}, 122},
    {{kWallLeft, kTorso, kWallLeft}, {"walker", 2, 3, {"street/wall_left"}}, 124},
    {{kWallLeft, kTorso, kWallRight}, {"walker", 2, 3, {"street/wall_left", "street/wall_right"}}, 124},
    {{kTorso, kWallLeft, kTorso}, {"walker", 1, 3, {"street/wall_left"}}, 100},
    {{kWallRight, kWallLeft, kTorso}, {"walker", 1, 3, {"street/wall_right", "street/wall_left"}}, 100},
    {{kWallLeft, kTorso, kWallLeft, kWallRight}, {"walker", 2, 4, {"street/wall_left", "street/wall_right"}}, 100},
    {{kFloor}, {"floor", 0, 1, {}}, 111},
    {{kFloor, kTorso}, {"walker", 1, 2, {"floor"}}, 112},
    {{kFloor, kFloor, kTorso}, {"walker", 1, 2, {"floor"}}, 112},                   // within another object
    {{kWallLeft, kWallLeft, kTorso}, {"walker", 1, 3, {"street/wall_left"}}, 100},  // two bounces, two images
    {{kWallLeft, kFloor}, {"floor", 1, 2, {"street/wall_left"}}, 112},
    {{kWallLeft, kWallRight}, {}, 0},
};

TEST(Families, TypesOrdersAndCodesAreThoseOfTheDataset) {
  for (const Known& known : kKnown) {
    const Family found = family_of(known.meshes);
    EXPECT_EQ(found, known.family) << found.name() << ", wanted " << known.family.name();
    EXPECT_EQ(found.class_code(), known.class_code) << found.name();
  }
}

TEST(Families, AreSortedWithTheBackgroundLast) {
  std::vector<HandMadePath> paths;
  for (const Known& known : kKnown) paths.push_back(path_over(known.meshes));
  std::reverse(paths.begin(), paths.end());
  std::vector<std::string> names;
  for (const Family& family : find_families(make_paths(paths), walker_first()).families) names.push_back(family.name());
  const std::vector<std::string> expected{"walker",
                                          "walker: type 1, order 2 via floor",
                                          "walker: type 1, order 2 via street/wall_left",
                                          "walker: type 2, order 2 via street/wall_left",
                                          "walker: type 2, order 2 via street/wall_right",
                                          "walker: type 1, order 3 via street/wall_left",
                                          "walker: type 1, order 3 via street/wall_right, street/wall_left",
                                          "walker: type 2, order 3 via street/wall_left",
                                          "walker: type 2, order 3 via street/wall_left, street/wall_right",
                                          "walker: type 2, order 4 via street/wall_left, street/wall_right",
                                          "floor",
                                          "floor: type 1, order 2 via street/wall_left",
                                          "background"};
  EXPECT_EQ(names, expected);
}

TEST(Families, PartsDifferWhateverObjectsAreCalled) {
  std::vector<HandMadePath> paths;
  for (const Known& known : kKnown) paths.push_back(path_over(known.meshes));
  const std::vector<NamedGlobs> objects{{"background", {"pedestrian"}},
                                        {"background: type 1, order 2 via wall", {"street/floor"}}};
  const Families found = find_families(make_paths(paths), map_surfaces(*make_street(), objects));
  const std::vector<std::string> names = found.partition().names;
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), found.families.size());
  EXPECT_EQ(names.back(), "");
  EXPECT_NE(Family({"a", 1, 2, {"b, c"}}).key(), Family({"a", 1, 2, {"b", "c"}}).key());
}

TEST(Families, WithoutPathsThereIsTheBackground) {
  const Families none = find_families(make_paths({}), walker_first());
  ASSERT_EQ(none.families.size(), 1u);
  EXPECT_EQ(none.families.front(), Family{});
  EXPECT_TRUE(none.family_of_path.empty());
}

TEST(Families, NumberOfThreadsDoesNotMatter) {
  const Paths paths = make_paths(random_paths(200000, 0, 5, 3));
  test::same_on_any_threads([&] {
    const Families found = find_families(paths, walker_first());
    return std::pair(found.families, found.family_of_path);
  });
}

TEST(Families, CancelledJobStops) {
  Job job;
  job.cancel();
  EXPECT_THROW(find_families(make_paths(random_paths(10, 1, 3, 3)), walker_first(), &job), Cancelled);
}

TEST(Grouping, BatchesTellCoherentFromDiffuseAndImagesFromRays) {
  Paths paths = make_paths({{{kFloor, false}}, {{kFloor, true}}, {{kFloor, false}}, {{kFloor, false}, {kTorso, true}}});
  paths.frame.batches = 2;
  paths.batch = {0, 0, kNoBatch, 1};
  const Partition partition = by_batches()(paths, nullptr);
  const std::vector<std::string> names{"batch 0 coherent", "batch 0 diffuse", "batch 1 coherent", "batch 1 diffuse",
                                       "all batches"};
  EXPECT_EQ(partition.names, names);
  EXPECT_EQ(partition.group, (std::vector<uint32_t>{0, 1, 4, 3}));
}

TEST(Grouping, ByAllIsTheCombinationsThatOccur) {
  const Paths paths = make_paths({{{kFloor, false}}, {{kTorso, true}}, {{kFloor, false}, {kTorso, false}}});
  const Grouping bounces = by_selections({{"one", Selection::num_bounces(1, 1)}});
  const SurfaceMap surfaces = map_surfaces(*make_street(), {{"walker", {"pedestrian"}}});
  const Grouping objects = [&](const Paths& of, Job* job) { return find_families(of, surfaces, job).partition(); };
  const Partition partition = by_all({bounces, objects})(paths, nullptr);
  // clang-format off
  const std::vector<std::string> names{"one\x1fwalker\x1e" "0\x1e" "1", "one\x1f",
                                       "other\x1fwalker\x1e" "1\x1e" "2\x1estreet"};
  // clang-format on
  EXPECT_EQ(partition.names, names);
  EXPECT_EQ(partition.group, (std::vector<uint32_t>{1, 0, 2}));
  EXPECT_THROW(by_all({}), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_families
