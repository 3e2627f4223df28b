// Sample n = kBlock a + b of a tone is (c w^{kBlock a}) w^b: the first factor runs by multiplication from block to
// block, the second is a table of kBlock powers. Adding kTones tones per pass is then a small matrix product that
// stays in registers.
#include <algorithm>

#include "echopath/base/lanes/phasor.h"
#include "echopath/signal/methods/method.h"

namespace echopath {
namespace {

constexpr int kBlock = 32;
constexpr int kTones = 4;

struct Tones {
  alignas(64) double power_re[kTones][kBlock];  // w^b
  alignas(64) double power_im[kTones][kBlock];
  double step_re[kTones], step_im[kTones];  // w^kBlock
  double re[kTones], im[kTones];            // c w^{kBlock a}
};

ECHOPATH_INLINE void set_tone(Tones& tones, int k, double frequency, double re, double im) {
  double* pr = tones.power_re[k];
  double* pi = tones.power_im[k];
  for (int b = 0; b < kBlock; ++b) {
    const Phasor phasor = phasor_of_cycles(frequency * b);
    pr[b] = phasor.re;
    pi[b] = phasor.im;
  }
  const Phasor step = phasor_of_cycles(frequency * kBlock);
  tones.step_re[k] = step.re;
  tones.step_im[k] = step.im;
  tones.re[k] = re;
  tones.im[k] = im;
}

ECHOPATH_INLINE void add_block(const Tones& tones, double* out_re, double* out_im) {
  const double r0 = tones.re[0], r1 = tones.re[1], r2 = tones.re[2], r3 = tones.re[3];
  const double i0 = tones.im[0], i1 = tones.im[1], i2 = tones.im[2], i3 = tones.im[3];
  const auto& pr = tones.power_re;
  const auto& pi = tones.power_im;
  for (int b = 0; b < kBlock; ++b) {
    out_re[b] += (r0 * pr[0][b] - i0 * pi[0][b]) + (r1 * pr[1][b] - i1 * pi[1][b]) + (r2 * pr[2][b] - i2 * pi[2][b]) +
                 (r3 * pr[3][b] - i3 * pi[3][b]);
    out_im[b] += (r0 * pi[0][b] + i0 * pr[0][b]) + (r1 * pi[1][b] + i1 * pr[1][b]) + (r2 * pi[2][b] + i2 * pr[2][b]) +
                 (r3 * pi[3][b] + i3 * pr[3][b]);
  }
}

ECHOPATH_INLINE void advance(Tones& tones) {
  for (int k = 0; k < kTones; ++k) {
    const double re = tones.re[k] * tones.step_re[k] - tones.im[k] * tones.step_im[k];
    tones.im[k] = tones.re[k] * tones.step_im[k] + tones.im[k] * tones.step_re[k];
    tones.re[k] = re;
  }
}

// Adds carriers [first, first + count), count <= kTones, all of one group; missing tones have amplitude zero.
ECHOPATH_INLINE void add_tones(const Carriers* carriers, int first, int count, int64_t length, double* row) {
  Tones tones;
  for (int k = 0; k < kTones; ++k) {
    const int p = first + std::min(k, count - 1);
    set_tone(tones, k, carriers->frequency[p], k < count ? carriers->re[p] : 0.0, k < count ? carriers->im[p] : 0.0);
  }
  for (int64_t n = 0; n < length; n += kBlock) {
    add_block(tones, row + n, row + length + n);
    advance(tones);
  }
}

class Recurrence : public ToneMethod {
 public:
  explicit Recurrence(int num_samples)
      : ToneMethod((int64_t{num_samples} + kBlock - 1) / kBlock * kBlock, 0), num_samples_(num_samples) {}

  void add(const Carriers& carriers, Rows rows) const override {
    for (int first = 0; first < carriers.count;) {
      int count = 1;
      const uint32_t group = carriers.group[first];
      while (count < kTones && first + count < carriers.count && carriers.group[first + count] == group) ++count;
      run_simd<add_tones>(&carriers, first, count, row_length(), rows.of_group[group] + rows.first);
      first += count;
    }
  }

  void samples(const double* row, std::complex<double>* out) const override {
    for (int n = 0; n < num_samples_; ++n) out[n] = {row[n], row[n + row_length()]};
  }

 private:
  int num_samples_;
};

}  // namespace

std::unique_ptr<const ToneMethod> make_recurrence(int num_samples) { return std::make_unique<Recurrence>(num_samples); }

}  // namespace echopath
