#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <set>
#include <stdexcept>

#include "cpp/label/hand_made_paths.h"
#include "echopath/label/partition.h"

namespace echopath::test_partition {
namespace {

using namespace testing;

const std::vector<NamedSelection> kRoute{
    {"direct", "T 'pedestrian' R"}, {"wall", "T .* 'street/wall*' .* R"}, {"floor", "T .* 'street/floor' .* R"}};
const std::vector<NamedSelection> kBody{{"arms", Selection::touches("pedestrian/arms")}};

Paths some_paths() { return make_paths(random_paths(5000, 0, 4, 9)); }

TEST(Partition, FirstMatchWinsAndTheRestIsOther) {
  const Paths paths = make_paths(
      {{{kTorso, false}}, {{kFloor, false}, {kWallLeft, false}}, {{kFloor, false}}, {{kTorso, true}, {kTorso, true}}, {}});
  const Partition partition = make_partition(paths, kRoute);
  EXPECT_EQ(partition.names, (std::vector<std::string>{"direct", "wall", "floor", "other"}));
  EXPECT_EQ(partition.group, (std::vector<uint32_t>{0, 1, 2, 3, 3}));
}

TEST(Partition, IsDisjointAndComplete) {
  const Paths paths = some_paths();
  const Partition partition = make_partition(paths, kRoute);
  ASSERT_EQ(partition.group.size(), paths.offsets.size());
  std::set<uint32_t> seen;
  Selection earlier = ~Selection("T .* R");
  for (uint32_t part = 0; part < partition.names.size(); ++part) {
    const Selection mine = part < kRoute.size() ? kRoute[part].selection & ~earlier : ~earlier;
    const std::vector<uint8_t> taken = mine.matches(paths);
    for (size_t path = 0; path < taken.size(); ++path) EXPECT_EQ(partition.group[path] == part, taken[path] != 0);
    if (part < kRoute.size()) earlier = earlier | kRoute[part].selection;
    seen.insert(partition.group.begin(), partition.group.end());
  }
  EXPECT_EQ(seen.size(), partition.names.size());
}

// Many parts look at the bits of meshes first.
TEST(Partition, ManyPartsTakeWhatEachWouldAlone) {
  const Paths paths = some_paths();
  const std::vector<NamedSelection> parts{
      {"one on a wall", "T 'street/wall*' R"},
      {"both walls", "T .* 'street/wall_left' .* 'street/wall_right' .* R"},
      {"a wall or an arm", "T ['street/wall_left' 'pedestrian/arms'] S'street/floor'* R"},
      {"no floor", "T [^ 'street/floor']{2} R"},
      {"rough", "T D .* R"},
      {"neither", ~Selection::touches("pedestrian") & Selection::num_bounces(2, 3)},
      {"torso or long", Selection::touches("pedestrian/torso") | Selection::num_bounces(4)}};
  const Partition partition = make_partition(paths, parts);
  std::vector<uint32_t> first(paths.offsets.size(), static_cast<uint32_t>(parts.size()));
  for (auto part = static_cast<uint32_t>(parts.size()); part-- > 0;) {
    const std::vector<uint8_t> taken = parts[part].selection.matches(paths);
    for (size_t path = 0; path < taken.size(); ++path) first[path] = taken[path] ? part : first[path];
  }
  EXPECT_EQ(partition.group, first);
  EXPECT_EQ(std::set<uint32_t>(first.begin(), first.end()).size(), parts.size() + 1);
}

// More meshes than bits: some share one.
TEST(Partition, MeshesThatShareABitAreToldApart) {
  constexpr uint32_t kMeshes = 130;
  const auto name_of = [](uint32_t mesh) { return std::string("m").append(std::to_string(mesh)); };
  auto scene = std::make_shared<Scene>();
  for (uint32_t mesh = 0; mesh < kMeshes; ++mesh) add_node(*scene, name_of(mesh), -1, true);
  std::vector<HandMadePath> hand_made;
  for (uint32_t i = 0; i < 3000; ++i) hand_made.push_back({{i % kMeshes, false}, {(i * 7 + i / kMeshes) % kMeshes, true}});
  Paths paths = make_paths(hand_made);
  paths.scene = scene;
  const std::vector<uint32_t> order{64, 0, 128, 1, 65, 129, 63, 127};
  std::vector<NamedSelection> parts;
  for (const uint32_t mesh : order) parts.push_back({name_of(mesh), Selection::touches(name_of(mesh))});
  const Partition partition = make_partition(paths, parts);
  for (size_t path = 0; path < hand_made.size(); ++path) {
    const auto touched = std::find_if(order.begin(), order.end(), [&](uint32_t mesh) {
      return hand_made[path][0].mesh_id == mesh || hand_made[path][1].mesh_id == mesh;
    });
    ASSERT_EQ(partition.group[path], static_cast<uint32_t>(touched - order.begin())) << path;
  }
}

TEST(Partition, WithoutPartsAllIsOther) {
  const Partition partition = make_partition(some_paths(), {});
  EXPECT_EQ(partition.names, std::vector<std::string>{"other"});
  EXPECT_EQ(std::set<uint32_t>(partition.group.begin(), partition.group.end()), std::set<uint32_t>{0});
}

TEST(Partition, BadNamesAreErrors) {
  const Paths paths = some_paths();
  EXPECT_THROW(make_partition(paths, {{"other", "T . R"}}), std::invalid_argument);
  EXPECT_THROW(make_partition(paths, {{"", "T . R"}}), std::invalid_argument);
  EXPECT_THROW(make_partition(paths, {{"a", "T . R"}, {"a", "T . . R"}}), std::invalid_argument);
  EXPECT_THROW(make_partition(paths, {{"a", Selection::touches("nobody")}}), std::invalid_argument);
}

TEST(CombinedPartition, GroupsAreTheCombinationsThatOccur) {
  const Paths paths = some_paths();
  const CombinedPartition combined = combine({make_partition(paths, kRoute), make_partition(paths, kBody)});
  std::set<std::pair<uint32_t, uint32_t>> occurring;
  for (size_t path = 0; path < paths.offsets.size(); ++path) {
    const uint32_t route = combined.partitions[0].group[path], body = combined.partitions[1].group[path];
    occurring.insert({route, body});
    ASSERT_LT(combined.group[path], combined.num_groups);
    EXPECT_EQ(combined.part_in(combined.group[path], 0), route);
    EXPECT_EQ(combined.part_in(combined.group[path], 1), body);
  }
  EXPECT_EQ(combined.num_groups, occurring.size());
  EXPECT_EQ(combined.num_groups, 8u);  // four routes, each with and without arms
  EXPECT_EQ(combined.part_of_group.size(), 2u * combined.num_groups);
}

TEST(CombinedPartition, LeavesOutCombinationsThatDoNotOccur) {
  const Paths paths = make_paths({{{kWallLeft, false}, {kArmLeft, false}}, {{kFloor, false}}});
  const CombinedPartition combined = combine({make_partition(paths, kRoute), make_partition(paths, kBody)});
  EXPECT_EQ(combined.num_groups, 2u);
  EXPECT_EQ(combined.group, (std::vector<uint32_t>{0, 1}));
  EXPECT_EQ(combined.part_of_group, (std::vector<uint32_t>{1, 0, 2, 1}));
}

// Each path carries one whole number, so that sums in any order are exact.
TEST(CombinedPartition, SumsOfGroupsAreSumsOfParts) {
  using Value = std::complex<double>;
  constexpr size_t kSize = 3;
  const Paths paths = some_paths();
  const CombinedPartition combined = combine({make_partition(paths, kRoute), make_partition(paths, kBody)});
  const auto value_of = [](size_t path, size_t i) { return Value(static_cast<double>(path), static_cast<double>(i)); };
  std::vector<Value> by_group(combined.num_groups * kSize);
  for (size_t path = 0; path < paths.offsets.size(); ++path) {
    for (size_t i = 0; i < kSize; ++i) by_group[combined.group[path] * kSize + i] += value_of(path, i);
  }
  for (size_t partition = 0; partition < 2; ++partition) {
    for (uint32_t part = 0; part < combined.partitions[partition].names.size(); ++part) {
      std::vector<Value> direct(kSize);
      for (size_t path = 0; path < paths.offsets.size(); ++path) {
        if (combined.partitions[partition].group[path] != part) continue;
        for (size_t i = 0; i < kSize; ++i) direct[i] += value_of(path, i);
      }
      std::vector<Value> sum(kSize);
      for (uint32_t group = 0; group < combined.num_groups; ++group) {
        if (combined.part_in(group, partition) != part) continue;
        for (size_t i = 0; i < kSize; ++i) sum[i] += by_group[group * kSize + i];
      }
      EXPECT_EQ(sum, direct);
    }
  }
}

TEST(CombinedPartition, NoPathsGiveNoGroups) {
  const Paths none = make_paths({});
  const CombinedPartition combined = combine({make_partition(none, kRoute), make_partition(none, kBody)});
  EXPECT_EQ(combined.num_groups, 0u);
}

TEST(CombinedPartition, BadInputIsAnError) {
  const Paths paths = some_paths();
  EXPECT_THROW(combine({}), std::invalid_argument);
  EXPECT_THROW(combine({make_partition(paths, kRoute), make_partition(make_paths({}), kBody)}), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_partition
