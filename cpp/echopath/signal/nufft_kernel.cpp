#include "echopath/signal/nufft_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echopath {
namespace {

using Real = long double;

// Measured rms error over the samples of one tone of unit amplitude, for width 3, 4, ... (test_methods.cpp holds them
// to it).
constexpr double kToneError[] = {8.3e-3, 8.3e-4, 9.8e-5, 8.6e-6, 8.8e-7, 9.8e-8, 1.25e-8,
                                 1.45e-9, 1.6e-10, 1.65e-11, 1.75e-12, 2.0e-13, 6.5e-14, 0.0};

Real kernel_value(Real beta, int width, Real u) {
  const Real x = 2 * u / width;
  return std::exp(beta * (std::sqrt(std::max(Real{0}, 1 - x * x)) - 1));
}

// Coefficients (lowest power first) of the polynomial through `value` at the count Chebyshev nodes of [-1, 1].
std::vector<Real> polynomial_through_chebyshev_nodes(const std::vector<Real>& value) {
  const int count = static_cast<int>(value.size());
  std::vector<Real> sum(count), previous(count), current(count);
  current[0] = 1;  // T_0
  for (int k = 0; k < count; ++k) {
    Real weight = 0;
    for (int i = 0; i < count; ++i) {
      weight += value[i] * std::cos(k * (i + Real{0.5}) * std::numbers::pi_v<Real> / count);
    }
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

}  // namespace

int NufftKernel::width_for(double tolerance) {
  int width = kMinWidth;
  while (width < kMaxWidth && kToneError[width - kMinWidth] > tolerance) ++width;
  return width;
}

NufftKernel::NufftKernel(int kernel_width)
    : width(kernel_width), beta(0.98 * std::numbers::pi * kernel_width * 0.75) {
  const int terms = degree(width) + 1, stride = padded(width);
  coefficients.assign(static_cast<size_t>(terms) * stride, 0.0);
  std::vector<Real> value(terms);
  for (int piece = 0; piece < width; ++piece) {
    for (int i = 0; i < terms; ++i) {
      const Real t = std::cos((i + Real{0.5}) * std::numbers::pi_v<Real> / terms);
      value[i] = kernel_value(beta, width, piece - Real(width) / 2 + (t + 1) / 2);
    }
    const std::vector<Real> power = polynomial_through_chebyshev_nodes(value);
    for (int d = 0; d < terms; ++d) {
      coefficients[static_cast<size_t>(terms - 1 - d) * stride + piece] = static_cast<double>(power[d]);
    }
  }
}

double NufftKernel::transform(double cycles) const {
  // u = (width / 2) sin(a) takes the root away; the midpoint rule then errs only at the ends, by about 1e-5 exp(-beta).
  constexpr int kNodes = 256;
  double sum = 0.0;
  for (int i = 0; i < kNodes; ++i) {
    const double a = std::numbers::pi * ((i + 0.5) / kNodes - 0.5);
    const double u = 0.5 * width * std::sin(a);
    sum += std::exp(beta * (std::cos(a) - 1.0)) * std::cos(2.0 * std::numbers::pi * cycles * u) * std::cos(a);
  }
  return sum * std::numbers::pi / kNodes * 0.5 * width;
}

}  // namespace echopath
