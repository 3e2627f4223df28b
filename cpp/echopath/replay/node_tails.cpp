#include "echopath/replay/node_tails.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/simd.h"

namespace echopath {
namespace {

constexpr double kShareOfBeforeLast = 0.25;

// Values relative to those of the first node: the sums must not drown in the rounding of whole delays.
ECHOPATH_INLINE void add_node(const double* values, const double* first, double weight_before_last, double weight_last, size_t count,
                            double* __restrict before_last, double* __restrict last) {
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

ECHOPATH_INLINE double modulus(const double* complex) { return std::sqrt(complex[0] * complex[0] + complex[1] * complex[1]); }

ECHOPATH_INLINE void raise_by_amplitudes(const double* before_last, const double* last, size_t count, double* __restrict tail) {
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

// Last two coefficients of one piece, for `count` sequences [node, count] at its nodes.
class Coefficients {
 public:
  Coefficients(const FrameNodes& nodes, size_t count) : nodes_(nodes), before_last_(count), last_(count) {}

  void find(const double* values, int piece) {
    const size_t count = last_.size(), order = static_cast<size_t>(nodes_.order);
    std::fill(before_last_.begin(), before_last_.end(), 0.0);
    std::fill(last_.begin(), last_.end(), 0.0);
    const double* first = values + static_cast<size_t>(piece) * order * count;
    for (size_t k = 1; k < order; ++k) {
      run_simd<add_node>(first + k * count, first, nodes_.tail[k], nodes_.tail[order + k], count, before_last_.data(), last_.data());
    }
  }
  const double* before_last() const { return before_last_.data(); }
  const double* last() const { return last_.data(); }

 private:
  const FrameNodes& nodes_;
  std::vector<double> before_last_, last_;
};

}  // namespace

NodeTails node_tails(const FrameNodes& nodes, const Echoes& echoes) {
  const auto num_paths = static_cast<size_t>(echoes.num_echoes);
  const auto* amplitude = reinterpret_cast<const double*>(echoes.amplitude.data());
  NodeTails tails{std::vector<double>(num_paths), std::vector<double>(num_paths)};
  Coefficients of_delays(nodes, num_paths), of_amplitudes(nodes, 2 * num_paths);
  for (int piece = 0; piece < nodes.num_pieces(); ++piece) {
    of_delays.find(echoes.delay.data(), piece);
    run_simd<raise_by_delays>(of_delays.before_last(), of_delays.last(), num_paths, tails.delay.data());
    of_amplitudes.find(amplitude, piece);
    run_simd<raise_by_amplitudes>(of_amplitudes.before_last(), of_amplitudes.last(), num_paths, tails.amplitude.data());
  }
  std::vector<double> largest(num_paths);
  for (size_t node = 0; node < nodes.times.size(); ++node) {
    run_simd<raise_by_norms>(amplitude + 2 * node * num_paths, num_paths, largest.data());
  }
  run_simd<divide_by_roots>(largest.data(), num_paths, tails.amplitude.data());
  return tails;
}

double tail_of(const FrameNodes& nodes, const std::vector<double>& values) {
  Coefficients coefficients(nodes, 1);
  double tail = 0.0;
  for (int piece = 0; piece < nodes.num_pieces(); ++piece) {
    coefficients.find(values.data(), piece);
    run_simd<raise_by_delays>(coefficients.before_last(), coefficients.last(), 1, &tail);
  }
  return tail;
}

}  // namespace echopath
