// Which paths share a random phase: against the sequences of their diffuse hits, forward and backward.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "echopath/power/shared_phase.h"

namespace echopath::test_shared_phase {
namespace {

// One of 16 points, which differ in one to four of what names a point: mesh, triangle and both coordinates.
Hit point(uint32_t bits) {
  return {bits & 1u, bits >> 1 & 1u, bits >> 2 & 1u ? 0.5f : 0.25f, bits >> 3 & 1u ? 0.125f : 0.0f};
}

struct Walk {
  std::vector<uint32_t> points;
  std::vector<bool> is_diffuse;

  std::vector<uint32_t> diffuse_points() const {
    std::vector<uint32_t> found;
    for (size_t k = 0; k < points.size(); ++k) {
      if (is_diffuse[k]) found.push_back(points[k]);
    }
    return found;
  }
};

Paths record_of(const std::vector<Walk>& walks) {
  Paths paths;
  auto hits = std::make_shared<std::vector<Hit>>();
  for (const Walk& walk : walks) {
    paths.offsets.push_back(std::ssize(*hits));
    paths.num_bounces.push_back(static_cast<uint8_t>(walk.points.size()));
    uint64_t diffuse = 0;
    for (size_t k = 0; k < walk.points.size(); ++k) {
      hits->push_back(point(walk.points[k]));
      diffuse |= uint64_t{walk.is_diffuse[k]} << k;
    }
    paths.diffuse.push_back(diffuse);
  }
  paths.hits = std::move(hits);
  return paths;
}

bool is_same_or_reversed(const std::vector<uint32_t>& a, std::vector<uint32_t> b) {
  if (a == b) return true;
  std::ranges::reverse(b);
  return a == b;
}

// Two points differ in one bit or more, and are told apart by each of the four.
TEST(SharedPhase, IsThatOfOnePointAlone) {
  std::vector<Walk> walks;
  for (uint32_t one = 0; one < 16; ++one) walks.push_back({{one}, {true}});
  const Paths paths = record_of(walks);
  for (int64_t a = 0; a < 16; ++a) {
    for (int64_t b = 0; b < 16; ++b) EXPECT_EQ(shares_phase(paths, a, b), a == b) << a << " " << b;
  }
}

// Specular hits between the diffuse ones count for nothing. Of few points many walks have the same.
TEST(SharedPhase, IsThatOfTheSameDiffuseHitsInEitherOrder) {
  std::mt19937 random(1);
  std::vector<Walk> walks;
  while (walks.size() < 300) {
    Walk walk;
    const size_t count = 1 + random() % 5;
    for (size_t k = 0; k < count; ++k) {
      walk.points.push_back(static_cast<uint32_t>(random() % 3));
      walk.is_diffuse.push_back(random() % 2 == 1);
    }
    if (!walk.diffuse_points().empty()) walks.push_back(walk);
  }
  const Paths paths = record_of(walks);
  int num_backward = 0;
  for (size_t a = 0; a < walks.size(); ++a) {
    for (size_t b = 0; b < walks.size(); ++b) {
      const auto of_a = walks[a].diffuse_points(), of_b = walks[b].diffuse_points();
      const bool expected = is_same_or_reversed(of_a, of_b);
      EXPECT_EQ(shares_phase(paths, static_cast<int64_t>(a), static_cast<int64_t>(b)), expected) << a << " " << b;
      num_backward += expected && of_a != of_b;
    }
  }
  EXPECT_GT(num_backward, 100);
}

}  // namespace
}  // namespace echopath::test_shared_phase
