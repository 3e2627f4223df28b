#pragma once
// What rays and segments meet in a geometry, to be compared bit by bit.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "echopath/trace/embree/embree_scene.h"

namespace echopath::testing {

struct Answers {
  std::vector<Hit> hits;
  std::vector<Vec3> positions;
  std::vector<uint8_t> blocked;
};

// Of 3000 rays from the origin about +x, one by one and in packets, and of segments from what they meet.
inline Answers answers_of(const EmbreeScene& geometry) {
  Answers answers;
  std::vector<Segment> segments;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  LaneVectors directions{};
  for (int i = 0; i < 3000; ++i) {
    const Vec3 direction = Vec3(1.0, 0.8 * uniform(random), 0.3 * uniform(random)).normalized();
    const Vec3 onward(10.0 + 10.0 * uniform(random), 6.0 * uniform(random), 3.0);
    directions.set(i % kPacketSize, unpacked(direction));
    if (i % kPacketSize == kPacketSize - 1) {
      EmbreeScene::PacketHits met;
      geometry.intersect(Vec3::Zero(), directions, kPacketSize, met);
      for (int lane = 0; lane < kPacketSize; ++lane) {
        if (met.verdicts[static_cast<size_t>(lane)] == EmbreeScene::Verdict::kHit) answers.hits.push_back(met[lane].hit);
      }
    }
    RayHit hit;
    if (geometry.intersect(Vec3::Zero(), direction, hit) != EmbreeScene::Verdict::kHit) continue;
    answers.hits.push_back(hit.hit);
    answers.positions.push_back(hit.position);
    segments.push_back({geometry.lifted(hit.position, hit.normal), onward});
  }
  answers.blocked.resize(segments.size());
  geometry.occluded(segments.data(), segments.size(), answers.blocked.data());
  return answers;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

inline void expect_same(const Answers& a, const Answers& b) {
  ASSERT_GT(a.hits.size(), 1000u);
  EXPECT_TRUE(same_bytes(a.hits, b.hits));
  EXPECT_TRUE(same_bytes(a.positions, b.positions));
  EXPECT_EQ(a.blocked, b.blocked);
}

}  // namespace echopath::testing
