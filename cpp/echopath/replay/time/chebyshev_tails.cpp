#include "echopath/replay/time/chebyshev_tails.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>

#include "echopath/base/lanes/simd.h"
#include "echopath/replay/time/time_grids.h"

namespace echopath {
namespace {

constexpr double kShareOfBeforeLast = 0.25;

// Adds values relative to those of the first node, so that the sums do not drown in the rounding of whole delays.
ECHOPATH_INLINE void add_node(const double* values, const double* first, double weight_before_last, double weight_last,
                              size_t count, double* __restrict before_last, double* __restrict last) {
  for (size_t i = 0; i < count; ++i) {
    const double value = values[i] - first[i];
    before_last[i] += weight_before_last * value;
    last[i] += weight_last * value;
  }
}

ECHOPATH_INLINE void raise_by_delays(const double* before_last, const double* last, size_t count, double* __restrict tail) {
  for (size_t i = 0; i < count; ++i) {
    tail[i] = std::max(tail[i], std::abs(last[i]) + kShareOfBeforeLast * std::abs(before_last[i]));
  }
}

ECHOPATH_INLINE double modulus(const double* complex) {
  return std::sqrt(complex[0] * complex[0] + complex[1] * complex[1]);
}

ECHOPATH_INLINE void raise_by_amplitudes(const double* before_last, const double* last, size_t count,
                                         double* __restrict tail) {
  for (size_t i = 0; i < count; ++i) {
    tail[i] = std::max(tail[i], modulus(last + 2 * i) + kShareOfBeforeLast * modulus(before_last + 2 * i));
  }
}

ECHOPATH_INLINE void raise_by_norms(const double* amplitude, size_t count, double* __restrict largest) {
  for (size_t i = 0; i < count; ++i) {
    const double norm = amplitude[2 * i] * amplitude[2 * i] + amplitude[2 * i + 1] * amplitude[2 * i + 1];
    largest[i] = std::max(largest[i], norm);
  }
}

ECHOPATH_INLINE void divide_by_roots(const double* norm, size_t count, double* __restrict values) {
  for (size_t i = 0; i < count; ++i) values[i] = norm[i] > 0.0 ? values[i] / std::sqrt(norm[i]) : 0.0;
}

// Finds the last two coefficients of one piece, for `count` neighbouring sequences at its nodes, `stride` values apart.
class Coefficients {
 public:
  Coefficients(const FrameNodes& nodes, size_t count) : nodes_(nodes), before_last_(count), last_(count) {}

  void find(const double* values, int piece, size_t stride, size_t count) {
    const size_t order = static_cast<size_t>(nodes_.order);
    std::fill_n(before_last_.begin(), count, 0.0);
    std::fill_n(last_.begin(), count, 0.0);
    const double* first = values + static_cast<size_t>(piece) * order * stride;
    for (size_t k = 1; k < order; ++k) {
      run_simd<add_node>(first + k * stride, first, nodes_.tail[k], nodes_.tail[order + k], count, before_last_.data(),
                         last_.data());
    }
  }
  const double* before_last() const { return before_last_.data(); }
  const double* last() const { return last_.data(); }

 private:
  const FrameNodes& nodes_;
  std::vector<double> before_last_, last_;
};

constexpr size_t kSummedTogether = 128;  // paths whose sums stay in the first-level cache

}  // namespace

ChebyshevTails chebyshev_tails(const FrameNodes& nodes, const Echoes& echoes) {
  const auto num_paths = static_cast<size_t>(echoes.num_echoes);
  const auto* amplitude = reinterpret_cast<const double*>(echoes.amplitude.data());
  ChebyshevTails tails{std::vector<double>(num_paths), std::vector<double>(num_paths)};
  Coefficients of_delays(nodes, kSummedTogether), of_amplitudes(nodes, 2 * kSummedTogether);
  std::array<double, kSummedTogether> largest;
  for (size_t begin = 0; begin < num_paths; begin += kSummedTogether) {
    const size_t count = std::min(kSummedTogether, num_paths - begin);
    for (int piece = 0; piece < nodes.num_pieces(); ++piece) {
      of_delays.find(echoes.delay.data() + begin, piece, num_paths, count);
      run_simd<raise_by_delays>(of_delays.before_last(), of_delays.last(), count, tails.delay.data() + begin);
      of_amplitudes.find(amplitude + 2 * begin, piece, 2 * num_paths, 2 * count);
      run_simd<raise_by_amplitudes>(of_amplitudes.before_last(), of_amplitudes.last(), count,
                                    tails.amplitude.data() + begin);
    }
    largest.fill(0.0);
    for (size_t node = 0; node < nodes.times.size(); ++node) {
      run_simd<raise_by_norms>(amplitude + 2 * (node * num_paths + begin), count, largest.data());
    }
    run_simd<divide_by_roots>(largest.data(), count, tails.amplitude.data() + begin);
  }
  return tails;
}

std::vector<double> tails_of_logarithms(const FrameNodes& nodes, const Echoes& echoes) {
  const auto num_paths = static_cast<size_t>(echoes.num_echoes);
  const auto* amplitude = reinterpret_cast<const double*>(echoes.amplitude.data());
  std::vector<double> tails(num_paths);
  Coefficients coefficients(nodes, 2 * kSummedTogether);
  for (size_t begin = 0; begin < num_paths; begin += kSummedTogether) {
    const size_t count = std::min(kSummedTogether, num_paths - begin);
    for (int piece = 0; piece < nodes.num_pieces(); ++piece) {
      coefficients.find(amplitude + 2 * begin, piece, 2 * num_paths, 2 * count);
      run_simd<raise_by_amplitudes>(coefficients.before_last(), coefficients.last(), count, tails.data() + begin);
    }
  }
  return tails;
}

namespace {

constexpr double kSecondDerivativeMargin = 2.0;  // by how much the second derivative may exceed what the nodes tell

// Returns the natural logarithm of a positive normal number to 2e-6: that of 2^k (1 + y) / (1 - y), |y| < 0.18, by three
// terms of its series.
double quick_log(double x) {
  constexpr uint64_t kOneHalfRoot = std::bit_cast<uint64_t>(0.5 * std::numbers::sqrt2);
  const uint64_t shifted = std::bit_cast<uint64_t>(x) - kOneHalfRoot, fraction = shifted & ((uint64_t{1} << 52) - 1);
  const auto power = static_cast<double>(static_cast<int64_t>(shifted) >> 52);
  const double part = std::bit_cast<double>(fraction + kOneHalfRoot), y = (part - 1.0) / (part + 1.0), square = y * y;
  return power * std::numbers::ln2 + 2.0 * y * (1.0 + square * (1.0 / 3.0 + square * (1.0 / 5.0)));
}

// Returns the logarithm of the size of an amplitude, whose square may be too small for a number.
double log_of_size(std::complex<double> amplitude) {
  constexpr double kLeastNorm = 1e-280;
  const double norm = std::norm(amplitude);
  if (norm > kLeastNorm) return 0.5 * quick_log(norm);
  return quick_log(std::max(std::abs(amplitude), std::numeric_limits<double>::min()));
}

// Returns a bound of a function over a piece from its values [order] at `times`.
double bound_of_parabolas(const double* times, const double* values, size_t order) {
  double second_derivative = 0.0, widest = 0.0;
  for (size_t k = 1; k < order; ++k) {
    const double step = times[k] - times[k - 1];
    widest = std::max(widest, std::abs(step));
    if (k + 1 == order) continue;
    const double next = times[k + 1] - times[k],
                 rise = (values[k + 1] - values[k]) / next - (values[k] - values[k - 1]) / step;
    second_derivative = std::max(second_derivative, std::abs(2.0 * rise / (step + next)));
  }
  return *std::max_element(values, values + order) + kSecondDerivativeMargin * second_derivative * widest * widest / 8.0;
}

// Returns whether a function stays below `limit` between its nodes too, of which `value_at(node)` is the value at a node.
template <class ValueAt>
bool stays_below(const FrameNodes& nodes, const ValueAt& value_at, double limit) {
  const auto order = static_cast<size_t>(nodes.order);
  std::array<double, TimeGrids::kHighestOrder> values;
  for (size_t first = 0; first + order <= nodes.times.size(); first += order) {
    for (size_t k = 0; k < order; ++k) values[k] = value_at(first + k);
    if (!(bound_of_parabolas(&nodes.times[first], values.data(), order) < limit)) return false;
  }
  return true;
}

}  // namespace

bool is_dark(const FrameNodes& nodes, const Echoes& echoes, size_t echo, double limit) {
  const auto amplitude_at = [&](size_t node) {
    return echoes.amplitude[node * static_cast<size_t>(echoes.num_echoes) + echo];
  };
  for (size_t node = 0; node < nodes.times.size(); ++node) {
    if (!(std::norm(amplitude_at(node)) < limit * limit)) return false;
  }
  return stays_below(nodes, [&](size_t node) { return log_of_size(amplitude_at(node)); }, std::log(limit));
}

bool stays_below(const FrameNodes& nodes, const double* values, double limit) {
  return stays_below(nodes, [&](size_t node) { return values[node]; }, limit);
}

double tail_of(const FrameNodes& nodes, const std::vector<double>& values) {
  Coefficients coefficients(nodes, 1);
  double tail = 0.0;
  for (int piece = 0; piece < nodes.num_pieces(); ++piece) {
    coefficients.find(values.data(), piece, 1, 1);
    run_simd<raise_by_delays>(coefficients.before_last(), coefficients.last(), 1, &tail);
  }
  return tail;
}

}  // namespace echopath
