#include "echopath/trace/scatter/hit_samples.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/lanes/phasor.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/base/random.h"
#include "echopath/trace/scatter/scatter_points.h"

namespace echopath {
namespace {

// Returns the middle of one of 2^32 intervals of [0, 1]. It is never 0: a ray would then go a way of any probability,
// however small, and its weight is divided by that.
ECHOPATH_INLINE double unit_sample(uint32_t word) { return (static_cast<double>(word) + 0.5) * 0x1.0p-32; }

template <size_t kLanes>
ECHOPATH_INLINE PhiloxWords<kLanes> draw_words(uint64_t seed, Stream stream, uint64_t first, uint32_t dimension) {
  PhiloxWords<kLanes> words;
  for (size_t i = 0; i < kLanes; ++i) {
    words[0][i] = static_cast<uint32_t>(first + i);
    words[1][i] = static_cast<uint32_t>((first + i) >> 32);
    words[2][i] = dimension;
    words[3][i] = static_cast<uint32_t>(stream);
  }
  philox4x32(words, philox_key(seed));
  return words;
}

template <size_t kLanes>
struct SampleLanes {
  double *phase_re, *phase_im, *axis_sample, *lobe_sample, *survival_sample;
};

template <size_t kLanes>
ECHOPATH_INLINE void draw_samples(uint64_t seed, uint64_t first, uint32_t depth, SampleLanes<kLanes> out) {
  const PhiloxWords<kLanes> words = draw_words<kLanes>(seed, Stream::kPhase, first, depth);
  for (size_t i = 0; i < kLanes; ++i) {
    const Phasor phase = phasor_of_cycles(unit_sample(words[0][i]));
    out.phase_re[i] = phase.re;
    out.phase_im[i] = phase.im;
    out.axis_sample[i] = unit_sample(words[1][i]);
    out.lobe_sample[i] = unit_sample(words[2][i]);
    out.survival_sample[i] = unit_sample(words[3][i]);
  }
}

ECHOPATH_INLINE VectorOf<double> direction_of(double u, double v) {
  const double sine = std::sqrt(u);
  const Phasor turn = phasor_of_cycles(v);
  return {sine * turn.re, sine * turn.im, std::sqrt(1.0 - u)};
}

// Draws directions in place of x and y, which are the cells of the rays.
ECHOPATH_INLINE void draw_lobes(uint64_t seed, uint64_t first, LaneVectors* lanes) {
  const PhiloxWords<kPacketSize> words = draw_words<kPacketSize>(seed, Stream::kScatterPoint, first, 0);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const double u = (lanes->x[lane] + unit_interval(words[0][lane], words[1][lane])) * (1.0 / kScatterNetSize);
    const double v = (lanes->y[lane] + unit_interval(words[2][lane], words[3][lane])) * (1.0 / kScatterNetSize);
    lanes->set(lane, direction_of(u, v));
  }
}

}  // namespace

HitSamples hit_samples(uint64_t seed, int64_t ray, int depth) {
  double re, im;
  HitSamples samples;
  draw_samples<1>(seed, static_cast<uint64_t>(ray), static_cast<uint32_t>(depth),
                  {&re, &im, &samples.axis_sample, &samples.lobe_sample, &samples.survival_sample});
  samples.phase = {re, im};
  return samples;
}

Vec3 cosine_lobe(const std::array<double, 2>& random) { return packed(direction_of(random[0], random[1])); }

std::array<double, 2> numbers_of(const Vec3& of_cosine_lobe) {
  const double x = of_cosine_lobe[0], y = of_cosine_lobe[1], turn = std::atan2(y, x) / kTwoPi;
  const double below_one = 1.0 - 0x1.0p-53;
  return {std::min(x * x + y * y, below_one), std::min(turn - std::floor(turn), below_one)};
}

void PacketSamples::draw(uint64_t seed, int64_t first, int count, const int* batches) {
  ScatterCell shift{};
  for (int lane = 0; lane < count; ++lane) {
    const bool is_new = lane == 0 || batches[lane] != batches[lane - 1] || (first + lane) % kScatterNetSize == 0;
    if (is_new) shift = scatter_shift(seed, batches[lane], first + lane, 0);
    const ScatterCell cell = scatter_cell(shift, first + lane);
    lobe.x[lane] = cell[0];
    lobe.y[lane] = cell[1];
  }
  std::fill(lobe.x.lanes + count, lobe.x.lanes + kPacketSize, 0.0);
  std::fill(lobe.y.lanes + count, lobe.y.lanes + kPacketSize, 0.0);
  const auto index = static_cast<uint64_t>(first);
  using Lanes = SampleLanes<kPacketSize>;
  run_simd<&draw_samples<kPacketSize>>(
      seed, index, uint32_t{1},
      Lanes{phase_re.lanes, phase_im.lanes, axis_sample.lanes, lobe_sample.lanes, survival_sample.lanes});
  run_simd<&draw_lobes>(seed, index, &lobe);
}

void PacketSamples::draw_by_keys(uint64_t seed, const int64_t* keys, int count) {
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const int64_t key = keys[std::min(lane, count - 1)];  // the lanes behind hold finite numbers, too
    const HitSamples drawn = hit_samples(seed, key, 1);
    phase_re[lane] = drawn.phase.real();
    phase_im[lane] = drawn.phase.imag();
    axis_sample[lane] = drawn.axis_sample;
    lobe_sample[lane] = drawn.lobe_sample;
    survival_sample[lane] = drawn.survival_sample;
    lobe.set(lane, unpacked(cosine_lobe(uniform2(seed, Stream::kScatterPoint, static_cast<uint64_t>(key), 0))));
  }
}

}  // namespace echopath
