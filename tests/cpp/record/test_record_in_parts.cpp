// Records that are put together in parts, each of which is finished by itself.
#include <gtest/gtest.h>

#include "echopath/record/blocks/record_in_parts.h"
#include "records.h"

namespace echopath::test_record_in_parts {
namespace {

Hit hit(uint32_t mesh_id) { return {mesh_id, mesh_id + 100, 0.25f, 0.5f}; }

// Returns a block with the paths of one hit over these meshes.
PathBlock block_of(const std::vector<uint32_t>& meshes) {
  PathBlock block;
  for (const uint32_t mesh : meshes) {
    const Hit only[] = {hit(mesh)};
    block.add(only, 1, 1, std::complex<float>(static_cast<float>(mesh), 0.0f), 0);
  }
  block.statistics.num_queries = std::ssize(meshes);
  return block;
}

Paths joined(const std::vector<PathBlock>& blocks, std::optional<int64_t> paths_per_part,
             const std::function<Paths(Paths)>& finished) {
  Paths empty;
  empty.frame.statistics.num_rays = 50;
  RecordInParts record(empty, paths_per_part, finished);
  for (const PathBlock& block : blocks) record.append({&block}, nullptr);
  return record.take();
}

TEST(RecordInParts, IsThatOfAllBlocksWithoutWhatIsLeftOutOfItsParts) {
  const std::vector<PathBlock> blocks = {block_of({1, 2}), block_of({3}), block_of({}), block_of({4, 5, 6}), block_of({7})};
  const auto without_even_meshes = [](Paths part) {
    std::vector<uint8_t> keep;
    for (int64_t path = 0; path < part.num_paths(); ++path) keep.push_back(part.hits_of(path)->mesh_id % 2);
    Paths kept = part.select(keep).with_own_hits(nullptr);
    kept.frame.statistics.num_paths = kept.num_paths();
    kept.frame.statistics.num_faint_paths += part.num_paths() - kept.num_paths();
    return kept;
  };
  for (const std::optional<int64_t> per_part :
       {std::optional<int64_t>(), std::optional<int64_t>(1), std::optional<int64_t>(3)}) {
    const Paths paths = joined(blocks, per_part, without_even_meshes);
    ASSERT_EQ(paths.num_paths(), 4);
    EXPECT_EQ(paths.num_hits(), 4);
    for (int64_t path = 0; path < 4; ++path) {
      EXPECT_EQ(paths.hits_of(path)->mesh_id, 2 * path + 1);
      EXPECT_EQ(paths.weight[static_cast<size_t>(path)], std::complex<float>(2.0f * static_cast<float>(path) + 1.0f));
    }
    EXPECT_EQ(paths.frame.statistics.num_rays, 50);
    EXPECT_EQ(paths.frame.statistics.num_queries, 7);
    EXPECT_EQ(paths.frame.statistics.num_paths, 4);
    EXPECT_EQ(paths.frame.statistics.num_faint_paths, 3);
  }
}

TEST(RecordInParts, ColumnsThatOnlySomePartsHaveAreZeroInTheOthers) {
  const std::vector<PathBlock> blocks = {block_of({1, 2}), block_of({3, 4}), block_of({5})};
  const auto finished = [](Paths part) {
    const uint32_t first = part.offsets.empty() ? 0 : part.hits_of(0)->mesh_id;
    if (first == 1) part.jones.assign(2, JonesMatrix{1, 2, 3, 4});
    if (first == 3) {
      part.curved_cell.assign(2, {7.0f});
      part.passes = {{hit(8), 0}, {hit(9), 0}, {hit(10), 0}};
      part.pass_offsets = {0, 1, 3};
    }
    return part;
  };
  const Paths paths = joined(blocks, 1, finished);
  ASSERT_EQ(paths.num_paths(), 5);
  ASSERT_EQ(paths.jones.size(), 5u);
  ASSERT_EQ(paths.curved_cell.size(), 5u);
  for (size_t path = 0; path < 5; ++path) {
    EXPECT_EQ(paths.jones[path], (path < 2 ? JonesMatrix{1, 2, 3, 4} : JonesMatrix{}));
    EXPECT_EQ(paths.curved_cell[path][0], path == 2 || path == 3 ? 7.0f : 0.0f);
  }
  std::vector<std::vector<uint32_t>> passed;
  for (size_t path = 0; path < 5; ++path) {
    passed.emplace_back();
    for (const Pass& pass : paths.passes_of(path)) passed.back().push_back(pass.hit.mesh_id);
  }
  EXPECT_EQ(passed, (std::vector<std::vector<uint32_t>>{{}, {}, {8}, {9, 10}, {}}));
}

}  // namespace
}  // namespace echopath::test_record_in_parts
