// Runs of hits are told apart by their contents, their kind and nothing else.
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "echopath/replay/evaluate/segment_ids.h"

namespace echopath::test_segment_ids {
namespace {

// Triangles of hits that lie one after another; many runs of them have the same contents.
std::vector<Hit> hits_of(uint32_t num_triangles) {
  std::vector<Hit> hits(400);
  for (size_t k = 0; k < hits.size(); ++k) hits[k] = {0, static_cast<uint32_t>(k * k) % num_triangles, 0.25f, 0.5f};
  return hits;
}

TEST(SegmentIds, RunsHaveTheValuesOfAMapOfTheirContents) {
  SegmentIds ids;
  for (const uint32_t num_triangles : {7u, 23u}) {
    const std::vector<Hit> hits = hits_of(num_triangles);
    std::map<std::tuple<std::vector<uint32_t>, uint64_t>, uint32_t> expected;
    for (size_t first = 0; first + 3 < hits.size(); ++first) {
      for (const int count : {1, 2, 3}) {
        for (const uint64_t kind : {0, 5}) {
          std::vector<uint32_t> triangles;
          for (int k = 0; k < count; ++k) triangles.push_back(hits[first + static_cast<size_t>(k)].triangle_id);
          const auto next = static_cast<uint32_t>(expected.size());
          const auto [known, is_new] = expected.emplace(std::tuple(triangles, kind), next);
          uint32_t& found = ids(hits.data() + first, count, kind);
          ASSERT_EQ(found, is_new ? SegmentIds::kNone : known->second);
          found = known->second;
        }
      }
    }
    ids.clear();
  }
}

// The number of a run's clearing has 16 bits.
TEST(SegmentIds, AreForgottenAfterAnyNumberOfClearings) {
  const std::vector<Hit> hits = hits_of(7);
  SegmentIds ids;
  ids(hits.data(), 2, 0) = 3;
  for (int clearing = 0; clearing < 0x10000; ++clearing) ids.clear();
  EXPECT_EQ(ids(hits.data(), 2, 0), SegmentIds::kNone);
  EXPECT_EQ(ids(hits.data(), 1, 0), SegmentIds::kNone);
}

}  // namespace
}  // namespace echopath::test_segment_ids
