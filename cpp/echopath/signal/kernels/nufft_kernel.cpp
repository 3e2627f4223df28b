#include "echopath/signal/kernels/nufft_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "echopath/base/lanes/phasor.h"
#include "echopath/base/lanes/simd.h"

namespace echopath {
namespace {

using Real = long double;

// Largest measured rms error over the samples of one tone of unit amplitude, for width 3, 4, ..., whatever the number of
// samples (test_methods.cpp holds them to it).
constexpr double kToneError[] = {8.8e-3,  8.9e-4,  1.0e-4,   8.7e-6,   8.9e-7,  9.7e-8,  1.25e-8,
                                 1.45e-9, 1.6e-10, 1.65e-11, 1.75e-12, 2.0e-13, 6.5e-14, 0.0};

// Returns beta as a share of pi width (1 - 1 / 4), where the kernel's spectrum begins to alias. The error is least near
// 0.98; for width 8, which the default tolerance takes, the share was found to a finer step.
double beta_share(int width) { return width == 8 ? 0.985 : 0.98; }

Real kernel_value(Real beta, int width, Real u) {
  const Real x = 2 * u / width;
  return std::exp(beta * (std::sqrt(std::max(Real{0}, 1 - x * x)) - 1));
}

// Returns Chebyshev polynomial k at node i of count: [k, i].
std::vector<Real> chebyshev_table(int count) {
  std::vector<Real> table;
  for (int k = 0; k < count; ++k) {
    for (int i = 0; i < count; ++i) table.push_back(std::cos(k * (i + Real{0.5}) * std::numbers::pi_v<Real> / count));
  }
  return table;
}

// Returns the coefficients (lowest power first) of the polynomial through `value` at the count Chebyshev nodes of [-1, 1].
std::vector<Real> polynomial_through_chebyshev_nodes(const std::vector<Real>& value, const std::vector<Real>& table) {
  const int count = static_cast<int>(value.size());
  std::vector<Real> sum(count), previous(count), current(count);
  current[0] = 1;  // T_0
  for (int k = 0; k < count; ++k) {
    Real weight = 0;
    for (int i = 0; i < count; ++i) weight += value[i] * table[static_cast<size_t>(k) * count + i];
    weight *= (k == 0 ? Real{1} : Real{2}) / count;
    for (int power = 0; power < count; ++power) sum[power] += weight * current[power];
    // T_{k+1} = 2 t T_k - T_{k-1}, and T_1 = t.
    std::vector<Real> next(count);
    for (int power = 0; power + 1 < count; ++power) next[power + 1] = (k == 0 ? 1 : 2) * current[power];
    for (int power = 0; power < count; ++power) next[power] -= k == 0 ? Real{0} : previous[power];
    previous = std::move(current);
    current = std::move(next);
  }
  return sum;
}

ECHOPATH_INLINE void add_cosines(double weight, double cycles, int count, double* sums) {
  for (int i = 0; i < count; ++i) sums[i] += weight * phasor_of_cycles(cycles * i).re;
}

}  // namespace

int NufftKernel::width_for(double tolerance) {
  int width = kMinWidth;
  while (width < kMaxWidth && kToneError[width - kMinWidth] > tolerance) ++width;
  return width;
}

NufftKernel::NufftKernel(int kernel_width)
    : width(kernel_width), beta(beta_share(kernel_width) * std::numbers::pi * kernel_width * 0.75) {
  const int terms = degree(width) + 1, stride = padded(width);
  coefficients.assign(static_cast<size_t>(terms) * stride, 0.0);
  const std::vector<Real> table = chebyshev_table(terms);
  set_nodes();
  std::vector<Real> value(terms);
  for (int piece = 0; piece < width; ++piece) {
    for (int i = 0; i < terms; ++i) {
      const Real t = table[static_cast<size_t>(terms) + i];
      value[i] = kernel_value(beta, width, piece - Real(width) / 2 + (t + 1) / 2);
    }
    const std::vector<Real> power = polynomial_through_chebyshev_nodes(value, table);
    for (int d = 0; d < terms; ++d) {
      coefficients[static_cast<size_t>(terms - 1 - d) * stride + piece] = static_cast<double>(power[d]);
    }
  }
}

// The substitution u = (width / 2) sin(a) takes the root away; the midpoint rule then errs only at the ends, by about 1e-4
// exp(-beta).
void NufftKernel::set_nodes() {
  constexpr int kNodes = 32;  // on the positive half: the kernel is even
  for (int i = 0; i < kNodes; ++i) {
    const double a = std::numbers::pi / 2 * (i + 0.5) / kNodes;
    places_.push_back(0.5 * width * std::sin(a));
    weights_.push_back(std::exp(beta * (std::cos(a) - 1.0)) * std::cos(a) * std::numbers::pi / kNodes * 0.5 * width);
  }
}

std::vector<double> NufftKernel::transform(double step, int count) const {
  std::vector<double> sums(count);
  for (size_t i = 0; i < places_.size(); ++i) run_simd<add_cosines>(weights_[i], step * places_[i], count, sums.data());
  return sums;
}

}  // namespace echopath
