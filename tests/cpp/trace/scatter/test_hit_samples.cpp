// The random samples of hits: the same one by one and in packets, and scattered as it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "echopath/trace/scatter/hit_samples.h"
#include "echopath/trace/scatter/scatter_points.h"

namespace echopath::test_hit_samples {
namespace {

constexpr double kRounding = 1e-15;  // of instruction sets with and without fused products

TEST(HitSamples, PacketsHoldTheNumbersOfEachRay) {
  constexpr uint64_t kSeed = 5;
  // A batch ends within the packet, and so do 256 rays that share a net.
  const std::array<int, kPacketSize> batches = {0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  for (const int64_t first : {int64_t{0}, int64_t{250}, (int64_t{1} << 32) - 7}) {
    for (const int count : {1, 7, kPacketSize}) {
      PacketSamples packet;
      packet.draw(kSeed, first, count, batches.data());
      for (int lane = 0; lane < count; ++lane) {
        const HitSamples expected = hit_samples(kSeed, first + lane, 1), found = packet.hit(lane);
        EXPECT_LT(std::abs(found.phase - expected.phase), kRounding);
        EXPECT_EQ(found.axis_sample, expected.axis_sample);
        EXPECT_EQ(found.lobe_sample, expected.lobe_sample);
        EXPECT_EQ(found.survival_sample, expected.survival_sample);
        const Vec3 lobe = cosine_lobe(scatter_point(kSeed, batches[static_cast<size_t>(lane)], first + lane, 0));
        EXPECT_LT((packet.lobe[lane] - lobe).norm(), kRounding);
      }
    }
  }
}

// Means over rays, within five standard errors of independent ones; the phase has the mean 0 and magnitude 1.
TEST(HitSamples, AreUniformAndIndependent) {
  constexpr int kRays = 40000;
  double survival = 0.0, lobe = 0.0, product = 0.0;
  std::complex<double> phase = 0.0;
  for (int ray = 0; ray < kRays; ++ray) {
    const HitSamples samples = hit_samples(11, ray, 2);
    EXPECT_NEAR(std::abs(samples.phase), 1.0, kRounding);
    survival += samples.survival_sample / kRays;
    lobe += samples.lobe_sample / kRays;
    product += samples.survival_sample * samples.lobe_sample / kRays;
    phase += samples.phase / double{kRays};
  }
  EXPECT_NEAR(survival, 0.5, 5 * std::sqrt(1.0 / 12 / kRays));
  EXPECT_NEAR(lobe, 0.5, 5 * std::sqrt(1.0 / 12 / kRays));
  EXPECT_NEAR(product, 0.25, 5 * std::sqrt(7.0 / 144 / kRays));
  EXPECT_LT(std::abs(phase), 5 / std::sqrt(double{kRays}));
}

// A sample of 0 would take a way of any probability. Of these rays one draws the word 0 for its lobe.
TEST(HitSamples, NoneIsZero) {
  constexpr uint64_t kSeed = 2230;
  const std::array<int, kPacketSize> batches{};
  double least = 1.0;
  PacketSamples packet;
  for (int64_t first = 0; first < int64_t{1} << 19; first += kPacketSize) {
    packet.draw(kSeed, first, kPacketSize, batches.data());
    for (int lane = 0; lane < kPacketSize; ++lane) least = std::min(least, packet.lobe_sample[lane]);
  }
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0x1.0p-32);  // it was there
}

// The next hit, the next ray of as many digits, another seed in its high half, and the directions have samples of their own.
TEST(HitSamples, HitsRaysAndSeedsAreIndependent) {
  constexpr int kRays = 40000;
  constexpr int64_t kFar = int64_t{1} << 32;
  double depth = 0.0, far = 0.0, seed = 0.0, direction = 0.0;
  for (int ray = 0; ray < kRays; ++ray) {
    const double sample = hit_samples(11, ray, 1).survival_sample;
    depth += sample * hit_samples(11, ray, 2).survival_sample / kRays;
    far += sample * hit_samples(11, kFar + ray, 1).survival_sample / kRays;
    seed += sample * hit_samples(kFar + 11, ray, 1).survival_sample / kRays;
    direction += sample * scatter_point(11, 0, ray, 0)[1] / kRays;
  }
  for (const double product : {depth, far, seed, direction}) EXPECT_NEAR(product, 0.25, 5 * std::sqrt(7.0 / 144 / kRays));
}

// Lambert: the density is cos/pi, so that the mean of the direction is 2/3 along the normal and that of its square 1/2.
TEST(HitSamples, LobeIsThatOfLambert) {
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
}  // namespace echopath::test_hit_samples
