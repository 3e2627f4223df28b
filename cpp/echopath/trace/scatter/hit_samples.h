#pragma once
// Draws the random samples of a hit; those of a packet's first hits are drawn all at once.
#include <array>
#include <complex>
#include <cstdint>

#include "echopath/base/geometry.h"
#include "echopath/trace/embree/packet.h"

namespace echopath {

// Holds the samples of hit number `depth` (1: the first) of a ray. All but the phase are uniform in (0, 1) with 32 bits.
struct HitSamples {
  std::complex<double> phase;    // of what it scatters, of magnitude 1
  double axis_sample = 0.0;      // decides the axis about which it turns polarisations
  double lobe_sample = 0.0;      // decides whether the ray goes on specularly
  double survival_sample = 0.0;  // decides whether it goes on at all
};
HitSamples hit_samples(uint64_t seed, int64_t ray, int depth);

// Returns a direction in a cosine lobe over a surface with its normal along z, from two numbers in [0, 1).
Vec3 cosine_lobe(const std::array<double, 2>& random);
// Returns the numbers of a direction of that lobe.
std::array<double, 2> numbers_of(const Vec3& of_cosine_lobe);

// Holds the samples of a packet's rays at their first hits: up to rounding, the results of hit_samples and of cosine_lobe of
// scatter_point for each ray.
struct PacketSamples {
  LaneValues phase_re, phase_im, axis_sample, lobe_sample, survival_sample;
  LaneVectors lobe;

  // Sets all samples to 0: rays leave specularly then, where any do.
  void clear() { *this = {}; }
  // Draws the samples of the rays [first, first + count); `batches` is [count].
  void draw(uint64_t seed, int64_t first, int count, const int* batches);
  // Draws the samples of rays [count] that are aimed at points, by the keys of these (surface_points.h).
  void draw_by_keys(uint64_t seed, const int64_t* keys, int count);
  HitSamples hit(int lane) const {
    return {{phase_re[lane], phase_im[lane]}, axis_sample[lane], lobe_sample[lane], survival_sample[lane]};
  }
};

}  // namespace echopath
