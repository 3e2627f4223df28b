#include "echopath/em/mie.h"

#include <cmath>
#include <complex>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"

namespace echopath {
namespace {

constexpr double kLargestSize = 1e6;  // ka
constexpr double kPointSize = 1e-8;   // ka, below which all but Rayleigh's dipoles are rounding
constexpr double kTiny = 1e-250;      // where the downward recurrence starts
constexpr double kHuge = 1e200;       // where it is scaled back
constexpr int kGuardOrders = 16;      // orders above the last one from which the downward recurrence forgets its start

// Returns the Riccati-Bessel functions x j_n(x), n = 0..count, by downward recurrence; upward they lose all digits above n =
// x.
std::vector<double> regular_functions(double x, int count) {
  std::vector<double> psi(static_cast<size_t>(count) + 1, 0.0);
  double above = 0.0, here = kTiny;
  for (int n = count + kGuardOrders; n >= 0; --n) {
    if (n <= count) psi[n] = here;
    const double below = (2 * n + 1) / x * here - above;
    above = here;
    here = below;
    if (std::abs(here) < kHuge) continue;
    here /= kHuge;
    above /= kHuge;
    for (int m = n; m <= count; ++m) psi[m] /= kHuge;
  }
  // The values are scaled by whichever of the two lowest orders is not near a zero.
  const double exact[2] = {std::sin(x), std::sin(x) / x - std::cos(x)};
  const int anchor = std::abs(psi[0]) >= std::abs(psi[1]) ? 0 : 1;
  const double scale = exact[anchor] / psi[anchor];
  for (double& value : psi) value *= scale;
  return psi;
}

// Returns x y_n(x), n = 0..count, by upward recurrence, the direction in which they grow.
std::vector<double> singular_functions(double x, int count) {
  std::vector<double> chi = {-std::cos(x), -std::cos(x) / x - std::sin(x)};
  for (int n = 1; n < count; ++n) {
    const auto i = static_cast<size_t>(n);
    chi.push_back((2 * n + 1) / x * chi[i] - chi[i - 1]);
  }
  return chi;
}

struct Coefficients {
  std::vector<std::complex<double>> a, b;  // [n - 1]: electric and magnetic multipoles
};

// Computes b_n = j_n / h_n, a_n = (x j_n)' / (x h_n)', h_n = j_n - j y_n (time factor e^{+jwt}).
Coefficients coefficients(double x) {
  const int count = static_cast<int>(x + 4.05 * std::cbrt(x) + 12.0);
  const std::vector<double> psi = regular_functions(x, count), chi = singular_functions(x, count);
  Coefficients out;
  for (int n = 1; n <= count; ++n) {
    const auto i = static_cast<size_t>(n);
    const double psi_slope = psi[i - 1] - n / x * psi[i], chi_slope = chi[i - 1] - n / x * chi[i];
    if (!std::isfinite(chi_slope)) break;  // far above x the multipoles vanish
    out.a.push_back(psi_slope / std::complex<double>(psi_slope, -chi_slope));
    out.b.push_back(psi[i] / std::complex<double>(psi[i], -chi[i]));
  }
  return out;
}

}  // namespace

double mie_rcs(double radius, double frequency, double bistatic_angle, ScatteringPlane plane) {
  require(std::isfinite(radius) && radius > 0, "radius", "must be finite and > 0 m", radius);
  require(std::isfinite(frequency) && frequency > 0, "frequency", "must be finite and > 0 Hz", frequency);
  require(bistatic_angle >= 0 && bistatic_angle <= kPi, "bistatic_angle", "must lie in [0, pi] rad", bistatic_angle);
  const double wavenumber = kTwoPi * frequency / kSpeedOfLight, x = wavenumber * radius;
  require(x <= kLargestSize, "radius", "must be such that 2 pi radius / wavelength <= 1e6", radius);

  const double cosine = -std::cos(bistatic_angle);  // of the scattering angle, measured from straight on
  if (x < kPointSize) {  // a_1 = 2j x^3 / 3, b_1 = -j x^3 / 3: the functions of the multipoles would overflow
    const double length = radius * (x * x) * (plane == ScatteringPlane::kH ? 2.0 - cosine : 2.0 * cosine - 1.0);
    return kPi * length * length;
  }
  const Coefficients multipoles = coefficients(x);
  // The loop computes pi_n = P_n^1 / sin, tau_n = d P_n^1 / d theta.
  std::complex<double> sum = 0.0;
  double pi_below = 0.0, pi_here = 1.0;
  for (size_t i = 0; i < multipoles.a.size(); ++i) {
    const auto n = static_cast<double>(i + 1);
    const double tau = n * cosine * pi_here - (n + 1) * pi_below;
    const double weight = (2 * n + 1) / (n * (n + 1));
    sum += plane == ScatteringPlane::kH ? weight * (multipoles.a[i] * pi_here + multipoles.b[i] * tau)
                                        : weight * (multipoles.a[i] * tau + multipoles.b[i] * pi_here);
    const double pi_above = ((2 * n + 1) * cosine * pi_here - (n + 1) * pi_below) / n;
    pi_below = pi_here;
    pi_here = pi_above;
  }
  return 4.0 * kPi * std::norm(sum) / (wavenumber * wavenumber);
}

}  // namespace echopath
