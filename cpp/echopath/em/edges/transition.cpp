#include "echopath/em/edges/transition.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {

// It is sqrt(pi) z e^{z^2} erfc(z) with z^2 = jx: by the power series of erf, by the continued fraction of erfc,
// or by its asymptotic series (Abramowitz and Stegun 7.1.5, 7.1.14, 7.1.23).
std::complex<double> transition(double x) {
  constexpr double kLarge = 20.0;
  if (x > kLarge) {
    const double inverse = 0.5 / x, square_of_inverse = inverse * inverse;
    return {1.0 - 3.0 * square_of_inverse * (1.0 - 35.0 * square_of_inverse),
            inverse * (1.0 - 15.0 * square_of_inverse * (1.0 - 63.0 * square_of_inverse))};
  }
  const std::complex<double> square(0.0, std::max(x, 0.0));
  if (x < 2.0) {
    const std::complex<double> z = std::sqrt(square);
    std::complex<double> power = z, sum = z;
    for (int n = 1; n <= 20; ++n) {
      power *= -square / static_cast<double>(n);
      sum += power / (2.0 * n + 1.0);
    }
    return z * std::exp(square) * (std::sqrt(kPi) - 2.0 * sum);
  }
  std::complex<double> fraction = 1.0;
  for (int k = static_cast<int>(8.0 + 60.0 / x); k > 0; --k) fraction = 1.0 + 0.5 * k / (square * fraction);
  return 1.0 / fraction;
}

}  // namespace echopath
