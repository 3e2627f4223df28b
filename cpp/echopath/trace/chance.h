#pragma once
// What chance decides where a ray meets a surface; of a packet's first hits all at once.
#include <array>
#include <complex>
#include <cstdint>

#include "echopath/base/geometry.h"
#include "echopath/trace/packet.h"

namespace echopath {

// Of hit number `depth` (1: the first) of a ray. Coins are uniform in (0, 1) with 32 bits.
struct HitSamples {
  std::complex<double> phase;  // of what it scatters, of magnitude 1
  double axis_coin = 0.0;      // of the axis about which it turns polarisations
  double lobe_coin = 0.0;      // whether the ray goes on specularly
  double survival_coin = 0.0;  // whether it goes on at all
};
HitSamples hit_samples(uint64_t seed, int64_t ray, int depth);

// A direction over a surface with its normal along z, in a cosine lobe: of two numbers in [0, 1).
Vec3 cosine_lobe(const std::array<double, 2>& random);

// Of the rays of a packet, at their first hits: what hit_samples and cosine_lobe of scatter_point give for each, but for rounding.
struct PacketChance {
  LaneValues phase_re, phase_im, axis_coin, lobe_coin, survival_coin;
  LaneVectors lobe;

  // Of rays [first, first + count); batches [count].
  void draw(uint64_t seed, int64_t first, int count, const int* batches);
  HitSamples hit(int lane) const {
    return {{phase_re[lane], phase_im[lane]}, axis_coin[lane], lobe_coin[lane], survival_coin[lane]};
  }
};

}  // namespace echopath
