// What chance decides at hits: the same one by one and in packets, and scattered as it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "echopath/trace/chance.h"
#include "echopath/trace/scatter_points.h"

namespace echopath {
namespace {

constexpr double kRounding = 1e-15;  // of instruction sets with and without fused products

TEST(Chance, PacketsHoldTheNumbersOfEachRay) {
  constexpr uint64_t kSeed = 5;
  // A batch ends within the packet, and so do 256 rays that share a net.
  const std::array<int, kPacketSize> batches = {0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  for (const int64_t first : {int64_t{0}, int64_t{250}, (int64_t{1} << 32) - 7}) {
    for (const int count : {1, 7, kPacketSize}) {
      PacketChance packet;
      packet.draw(kSeed, first, count, batches.data());
      for (int lane = 0; lane < count; ++lane) {
        const HitSamples expected = hit_samples(kSeed, first + lane, 1), found = packet.hit(lane);
        EXPECT_LT(std::abs(found.phase - expected.phase), kRounding);
        EXPECT_EQ(found.axis_coin, expected.axis_coin);
        EXPECT_EQ(found.lobe_coin, expected.lobe_coin);
        EXPECT_EQ(found.survival_coin, expected.survival_coin);
        const Vec3 lobe = cosine_lobe(scatter_point(kSeed, batches[static_cast<size_t>(lane)], first + lane, 0));
        EXPECT_LT((packet.lobe[lane] - lobe).norm(), kRounding);
      }
    }
  }
}

// Means over rays, within five standard errors of independent ones; the phase has the mean 0 and magnitude 1.
TEST(Chance, CoinsAreFairAndIndependent) {
  constexpr int kRays = 40000;
  double survival = 0.0, lobe = 0.0, product = 0.0;
  std::complex<double> phase = 0.0;
  for (int ray = 0; ray < kRays; ++ray) {
    const HitSamples chance = hit_samples(11, ray, 2);
    EXPECT_NEAR(std::abs(chance.phase), 1.0, kRounding);
    survival += chance.survival_coin / kRays;
    lobe += chance.lobe_coin / kRays;
    product += chance.survival_coin * chance.lobe_coin / kRays;
    phase += chance.phase / double{kRays};
  }
  EXPECT_NEAR(survival, 0.5, 5 * std::sqrt(1.0 / 12 / kRays));
  EXPECT_NEAR(lobe, 0.5, 5 * std::sqrt(1.0 / 12 / kRays));
  EXPECT_NEAR(product, 0.25, 5 * std::sqrt(7.0 / 144 / kRays));
  EXPECT_LT(std::abs(phase), 5 / std::sqrt(double{kRays}));
}

// A coin of 0 would take a way of any odds. Of these rays one draws the word 0 for its lobe.
TEST(Chance, NoCoinIsZero) {
  constexpr uint64_t kSeed = 2230;
  const std::array<int, kPacketSize> batches{};
  double least = 1.0;
  PacketChance packet;
  for (int64_t first = 0; first < int64_t{1} << 19; first += kPacketSize) {
    packet.draw(kSeed, first, kPacketSize, batches.data());
    for (int lane = 0; lane < kPacketSize; ++lane) least = std::min(least, packet.lobe_coin[lane]);
  }
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0x1.0p-32);  // it was there
}

// The next hit, the next ray of as many digits, another seed in its high half, and the directions have chance of their own.
TEST(Chance, HitsRaysAndSeedsAreIndependent) {
  constexpr int kRays = 40000;
  constexpr int64_t kFar = int64_t{1} << 32;
  double depth = 0.0, far = 0.0, seed = 0.0, direction = 0.0;
  for (int ray = 0; ray < kRays; ++ray) {
    const double coin = hit_samples(11, ray, 1).survival_coin;
    depth += coin * hit_samples(11, ray, 2).survival_coin / kRays;
    far += coin * hit_samples(11, kFar + ray, 1).survival_coin / kRays;
    seed += coin * hit_samples(kFar + 11, ray, 1).survival_coin / kRays;
    direction += coin * scatter_point(11, 0, ray, 0)[1] / kRays;
  }
  for (const double product : {depth, far, seed, direction}) EXPECT_NEAR(product, 0.25, 5 * std::sqrt(7.0 / 144 / kRays));
}

// Lambert: the density is cos/pi, so that the mean of the direction is 2/3 along the normal and that of its square 1/2.
TEST(Chance, LobeIsThatOfLambert) {
  constexpr int kSide = 200;
  Vec3 mean = Vec3::Zero();
  double squared = 0.0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec3 lobe = cosine_lobe({(i / kSide + 0.5) / kSide, (i % kSide + 0.5) / kSide});
    EXPECT_NEAR(lobe.norm(), 1.0, kRounding);
    mean += lobe / (kSide * kSide);
    squared += lobe.z() * lobe.z() / (kSide * kSide);
  }
  constexpr double kGrid = 1e-4;  // of the midpoint rule
  EXPECT_LT((mean - Vec3(0, 0, 2.0 / 3.0)).norm(), kGrid);
  EXPECT_NEAR(squared, 0.5, kGrid);
}

}  // namespace
}  // namespace echopath
