// The record that blocks of rays become: every path over the hits, with the weight and in the order in which it was added.
#include <gtest/gtest.h>

#include "records.h"

namespace echopath::test_path_block {
namespace {

using Complex = std::complex<double>;

constexpr float kRounding = 1e-6f;  // single precision, relative

Hit hit(uint32_t mesh_id) { return {mesh_id, mesh_id + 100, 0.25f, 0.5f}; }

struct Expected {
  std::vector<uint32_t> meshes;
  uint64_t diffuse;
  Complex weight;
};

std::vector<uint32_t> meshes_of(const Paths& paths, size_t path) {
  std::vector<uint32_t> meshes;
  for (int k = 0; k < paths.num_bounces[path]; ++k) meshes.push_back(paths.hits_of(static_cast<int64_t>(path))[k].mesh_id);
  return meshes;
}

void expect_paths(const Paths& paths, const std::vector<Expected>& expected) {
  ASSERT_EQ(paths.num_paths(), std::ssize(expected));
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(meshes_of(paths, i), expected[i].meshes) << i;
    EXPECT_EQ(paths.diffuse[i], expected[i].diffuse) << i;
    EXPECT_LT(std::abs(paths.weight[i] - std::complex<float>(expected[i].weight)), kRounding * std::abs(expected[i].weight));
  }
}

// Legs as lists of meshes in order of travel.
struct Legs {
  std::vector<std::vector<uint32_t>> in, out;
};

Complex factor(size_t leg, bool is_out) { return {1.0 + static_cast<double>(leg), is_out ? 0.5 : -0.25}; }

void add_fan(PathBlock& block, const Legs& legs, int max_bounces) {
  block.begin_fan(hit(0), 2, max_bounces);
  for (size_t i = 0; i < legs.in.size(); ++i) {
    block.add_leg_in(factor(i, false));
    for (const uint32_t mesh : legs.in[i]) block.add_leg_hit(hit(mesh));
  }
  for (size_t j = 0; j < legs.out.size(); ++j) {
    block.add_leg_out(factor(j, true));
    for (const uint32_t mesh : legs.out[j]) block.add_leg_hit(hit(mesh));
  }
  block.end_fan();
}

std::vector<Expected> pairs(const Legs& legs, size_t max_bounces) {
  std::vector<Expected> all;
  for (size_t i = 0; i < legs.in.size(); ++i) {
    for (size_t j = 0; j < legs.out.size(); ++j) {
      std::vector<uint32_t> meshes = legs.in[i];
      meshes.push_back(0);
      meshes.insert(meshes.end(), legs.out[j].begin(), legs.out[j].end());
      if (meshes.size() > max_bounces) continue;
      all.push_back({meshes, uint64_t{1} << legs.in[i].size(), factor(i, false) * factor(j, true)});
    }
  }
  return all;
}

TEST(PathBlock, FansAreAllPairsOfTheirLegs) {
  const std::vector<std::vector<uint32_t>> ways = {{}, {1}, {2}, {3, 4}, {5, 6}};
  for (const size_t num_in : {1, 2, 3, 5}) {
    for (const size_t num_out : {1, 2, 3, 5}) {
      for (const size_t max_bounces : {1, 2, 3, 4, 5}) {
        for (const bool is_bent_first : {false, true}) {
          Legs legs{{ways.begin(), ways.begin() + num_in}, {ways.begin(), ways.begin() + num_out}};
          if (is_bent_first) std::reverse(legs.in.begin(), legs.in.end());
          std::vector<PathBlock> blocks(2);
          add_fan(blocks[1], legs, static_cast<int>(max_bounces));
          expect_paths(record_of(blocks), pairs(legs, max_bounces));
        }
      }
    }
  }
}

// A direct way shares the hits of one over a mirror.
TEST(PathBlock, FansShareHits) {
  const Legs legs{{{}, {1}, {2}}, {{}, {1}, {2}}};
  std::vector<PathBlock> blocks(1);
  add_fan(blocks[0], legs, 4);
  const Paths paths = record_of(blocks);
  EXPECT_EQ(paths.num_paths(), 9);
  EXPECT_EQ(paths.num_hits(), 4 * 3);  // two ways in by two ways out over mirrors
}

TEST(PathBlock, OrderIsThatOfAdding) {
  PathBlock block;
  const Hit ray[] = {hit(7), hit(8)};
  const Legs legs{{{}, {1}}, {{}}};
  block.add(ray, 1, 1, std::complex<float>(2.0, 0.0), 0);
  add_fan(block, legs, 4);
  block.add_prefix(2, 1, std::complex<float>(3.0, 0.0), 0);
  block.end_ray(ray);
  add_fan(block, legs, 4);
  block.add_reversal(ray, 2, 1, std::complex<float>(4.0, 0.0), 0);
  std::vector<Expected> expected = {{{7}, 1, 2.0}};
  const std::vector<Expected> fan = pairs(legs, 4);
  expected.insert(expected.end(), fan.begin(), fan.end());
  expected.push_back({{7, 8}, 1, 3.0});
  expected.insert(expected.end(), fan.begin(), fan.end());
  expected.push_back({{8, 7}, 2, 4.0});
  // Behind a block of its own, so that places are not those of the block.
  std::vector<PathBlock> blocks(3);
  blocks[0].add(ray, 2, 3, std::complex<float>(5.0, 0.0), 0);
  blocks[2] = block;
  expected.insert(expected.begin(), {{7, 8}, 3, 5.0});
  expect_paths(record_of(blocks), expected);
}

TEST(PathBlock, ReversalsKeepDiffuseHitsDiffuse) {
  PathBlock block;
  const Hit ray[] = {hit(7), hit(8), hit(9)};
  block.add_reversal(ray, 3, 0b011, std::complex<float>(2.0, 0.0), 0);
  expect_paths(record_of({block}), {{{9, 8, 7}, 0b110, 2.0}});
}

TEST(PathBlock, FansHaveTheMatricesOfTheirPairs) {
  PathBlock block;
  for (const float first : {1.0f, 3.0f}) {
    add_fan(block, {{{}}, {{}, {1}}}, 4);
    block.add_pair_jones({first, 0.0f, 0.0f, 0.0f});
    block.add_pair_jones({first + 1.0f, 0.0f, 0.0f, 0.0f});
  }
  const Paths paths = record_of({block});
  ASSERT_EQ(paths.jones.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(paths.jones[i][0], std::complex<float>(1.0f + static_cast<float>(i))) << i;
}

TEST(PathBlock, OptionalColumnsStayWithTheirPaths) {
  PathBlock block;
  const Hit ray[] = {hit(7)};
  add_fan(block, {{{}, {1}}, {{}}}, 4);
  block.add(ray, 1, 0, std::complex<float>(2.0, 0.0), 0);
  block.set_curved_cell({1, 2, 3, 4, 5, 6, 7});
  add_fan(block, {{{}}, {{}}}, 4);
  const Paths paths = record_of({block});
  ASSERT_EQ(paths.curved_cell.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(paths.curved_cell[i][6], i == 2 ? 7.0f : 0.0f) << i;
  EXPECT_TRUE(paths.jones.empty());
}

// However the blocks come together, and whether room was made for them or not.
TEST(RecordWriter, RecordDoesNotDependOnHowItGrew) {
  std::vector<PathBlock> blocks(5);
  std::vector<Expected> expected;
  for (uint32_t k = 0; k < blocks.size(); ++k) {
    const Hit ray[] = {hit(k), hit(k + 10)};
    for (uint32_t i = 0; i <= k; ++i) {
      blocks[k].add(ray, 2, i, std::complex<float>(1.0f + static_cast<float>(i), static_cast<float>(k)), 0);
      expected.push_back({{k, k + 10}, i, Complex(1.0 + i, k)});
    }
    blocks[k].statistics.num_hits = 1 << k;
  }
  blocks[3].set_curved_cell({1, 2, 3, 4, 5, 6, 7});
  for (const size_t per_append : {0u, 1u, 2u}) {
    const Paths paths = record_of(blocks, per_append);
    expect_paths(paths, expected);
    ASSERT_EQ(paths.curved_cell.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(paths.curved_cell[i][6], i == 9 ? 7.0f : 0.0f) << i;
    EXPECT_EQ(paths.frame.statistics.num_hits, 31);
    EXPECT_EQ(paths.frame.statistics.num_paths, static_cast<int64_t>(expected.size()));
  }
}

// Arrays that have their room stay where they are.
TEST(RecordWriter, ExpectedBlocksMoveNothing) {
  std::vector<PathBlock> like(2);
  const Hit ray[] = {hit(1), hit(2)};
  for (int i = 0; i < 30; ++i) like[1].add(ray, 2, 0, std::complex<float>(1.0, 0.0), 0);
  like[1].set_curved_cell({1, 2, 3, 4, 5, 6, 7});
  Paths paths;
  RecordWriter record(paths);
  record.expect(like, 100);
  record.append({&like[1]});
  const int64_t* const offsets = paths.offsets.data();
  const auto* const weights = paths.weight.data();
  const auto* const cells = paths.curved_cell.data();
  for (int k = 1; k < 50; ++k) record.append({&like[1]});
  EXPECT_EQ(paths.offsets.data(), offsets);
  EXPECT_EQ(paths.weight.data(), weights);
  EXPECT_EQ(paths.curved_cell.data(), cells);
  record.finish();
  EXPECT_EQ(paths.num_hits(), 3000);
}

TEST(PathBlock, ClearedBlockIsEmpty) {
  PathBlock block;
  add_fan(block, {{{}, {1}}, {{}}}, 4);
  block.clear();
  EXPECT_EQ(block.num_paths(), 0u);
  EXPECT_EQ(block.num_hits(), 0u);
  EXPECT_EQ(record_of({block}).num_paths(), 0);
}

TEST(PathBlock, ChainsOfOneRayShareItsHits) {
  const std::vector<Hit> first = {{0, 1, 0.f, 0.f}, {1, 2, 0.f, 0.f}, {2, 3, 0.f, 0.f}}, second = {{3, 4, 0.f, 0.f}};
  PathBlock block;
  block.add_chain(2);
  block.add_chain(1);
  block.end_ray(first.data());
  block.end_ray(first.data());
  block.add_chain(1);
  block.end_ray(second.data());
  ASSERT_EQ(block.chains.size(), 3u);
  EXPECT_EQ(block.chain_hits.size(), 3u);
  EXPECT_EQ(block.chains[1].first, block.chains[0].first);
  EXPECT_EQ(block.chains[1].count, 1u);
  EXPECT_EQ(block.chain_hits[block.chains[2].first].triangle_id, 4u);
  EXPECT_EQ(block.num_hits(), 0u);
}

}  // namespace
}  // namespace echopath::test_path_block
