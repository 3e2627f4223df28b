#include "echopath/sim/stream/probe_sums.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/base/lanes/lanes.h"
#include "echopath/base/lanes/phasor.h"
#include "echopath/base/lanes/simd.h"

namespace echopath {
namespace {

// Adds carriers, as many as fill whole lanes, to sums [2, SampleRow::kSamples, kLanes] over samples that are evenly spaced,
// with one phasor for the first and one for the step between them.
template <int kLanes>
ECHOPATH_INLINE void add_tones(const double* frequency, const double* re, const double* im, int count, double first,
                               double step, double* sums) {
  using Vec = Lanes<double, kLanes>;
  Vec sum_re[SampleRow::kSamples], sum_im[SampleRow::kSamples];
  for (int s = 0; s < SampleRow::kSamples; ++s) {
    sum_re[s] = load_lanes<kLanes>(sums + s * kLanes);
    sum_im[s] = load_lanes<kLanes>(sums + (SampleRow::kSamples + s) * kLanes);
  }
  for (int p = 0; p < count; p += kLanes) {
    const Vec f = load_lanes<kLanes>(frequency + p), a = load_lanes<kLanes>(re + p), b = load_lanes<kLanes>(im + p);
    const auto start = phasor_of_cycles(f * first), turn = phasor_of_cycles(f * step);
    Vec c = a * start.re - b * start.im, d = a * start.im + b * start.re;
    for (int s = 0; s < SampleRow::kSamples; ++s) {
      sum_re[s] += c;
      sum_im[s] += d;
      const Vec next = c * turn.re - d * turn.im;
      d = c * turn.im + d * turn.re;
      c = next;
    }
  }
  for (int s = 0; s < SampleRow::kSamples; ++s) {
    store_lanes(sums + s * kLanes, sum_re[s]);
    store_lanes(sums + (SampleRow::kSamples + s) * kLanes, sum_im[s]);
  }
}

// Computes the powers of echoes, as many as fill whole lanes: those behind the last are 0.
ECHOPATH_INLINE void find_powers(const double* amplitude, int count, double* __restrict power, EchoPowerSums* out) {
  for (int p = 0; p < count; ++p)
    power[p] = amplitude[2 * p] * amplitude[2 * p] + amplitude[2 * p + 1] * amplitude[2 * p + 1];
  EchoPowerSums sums;
  for (int p = 0; p < count; p += EchoPowerSums::kLanes) {
    for (int lane = 0; lane < EchoPowerSums::kLanes; ++lane) {
      const double here = power[p + lane];
      sums.power[lane] += here;
      sums.root[lane] += std::sqrt(here);
      sums.largest[lane] = std::max(sums.largest[lane], here);
    }
  }
  *out = sums;
}

}  // namespace

EchoPowerSums powers_of(EchoStates& states, int count, double* power) {
  const int filled = (count + EchoPowerSums::kLanes - 1) / EchoPowerSums::kLanes * EchoPowerSums::kLanes;
  std::fill(states.amplitude + 2 * count, states.amplitude + 2 * filled, 0.0);
  EchoPowerSums sums;
  run_simd<find_powers>(states.amplitude, filled, power, &sums);
  return sums;
}

TonesOfRows::TonesOfRows(size_t num_rows) : first_(num_rows + 1), count_(num_rows), sums_(num_rows * kSums) {
  for (std::vector<double>* values : {&frequency_, &re_, &im_}) values->resize(Carriers::kCapacity + num_rows * kMaxLanes);
}

void TonesOfRows::sort(const Carriers& carriers) {
  std::ranges::fill(count_, 0);
  for (int p = 0; p < carriers.count; ++p) ++count_[carriers.group[p]];
  for (size_t row = 0; row < count_.size(); ++row) {
    first_[row + 1] = first_[row] + (count_[row] + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
    for (std::vector<double>* values : {&frequency_, &re_, &im_}) {
      std::fill(values->begin() + first_[row] + count_[row], values->begin() + first_[row + 1], 0.0);
    }
    count_[row] = first_[row];
  }
  for (int p = 0; p < carriers.count; ++p) {
    const auto to = static_cast<size_t>(count_[carriers.group[p]]++);
    frequency_[to] = carriers.frequency[p];
    re_[to] = carriers.re[p];
    im_[to] = carriers.im[p];
  }
}

void TonesOfRows::add(const Carriers& carriers, double first_sample, double step) {
  sort(carriers);
  for (size_t row = 0; row < count_.size(); ++row) {
    const auto at = static_cast<size_t>(first_[row]);
    const int num_tones = first_[row + 1] - first_[row];
    double* const to = sums_.data() + row * kSums;
    if (num_tones == 0) continue;
    run_simd_lanes<add_tones<8>, add_tones<4>>(&frequency_[at], &re_[at], &im_[at], num_tones, first_sample, step, to);
  }
}

void TonesOfRows::give(std::vector<SampleRow>& rows) const {
  const auto lanes = static_cast<size_t>(num_simd_lanes());
  for (size_t row = 0; row < rows.size(); ++row) {
    const double* from = sums_.data() + row * kSums;
    for (size_t s = 0; s < SampleRow::kSamples; ++s, from += lanes) {
      rows[row].re[s] = std::accumulate(from, from + lanes, rows[row].re[s]);
      rows[row].im[s] =
          std::accumulate(from + SampleRow::kSamples * lanes, from + (SampleRow::kSamples + 1) * lanes, rows[row].im[s]);
    }
  }
}

}  // namespace echopath
