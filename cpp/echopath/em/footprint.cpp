#include "echopath/em/footprint.h"

#include <cmath>

namespace echopath {

double first_order_footprint(const FootprintPhase& phase) {
  return std::exp(-(phase.g1 * phase.g1 + phase.g2 * phase.g2) / 24.0);
}

std::complex<double> second_order_footprint(const FootprintPhase& phase, double spread) {
  const double variance = spread * spread;
  const double a11 = variance * phase.h11, a12 = variance * phase.h12, a22 = variance * phase.h22;
  const double det = a11 * a22 - a12 * a12, trace = a11 + a22;
  // D_F = det(I + jA) = (1 - det) + j trace. Its root without cancellation: m + 1 - det >= 2 always, as m >= |1 - det|
  // and for det > 1 the matrix is definite, so trace^2 >= 4 det.
  const double m = std::hypot(1.0 - det, trace);
  const double root_real = std::sqrt(0.5 * (m + 1.0 - det));
  const double root_imag = trace / (2.0 * root_real);
  const double g_squared = phase.g1 * phase.g1 + phase.g2 * phase.g2;
  const double form = a11 * phase.g1 * phase.g1 + 2.0 * a12 * phase.g1 * phase.g2 + a22 * phase.g2 * phase.g2;
  const double turned = trace * g_squared - form;
  // The exponent is -variance/2 (g^2 + j turned) / D_F, in real numbers: std::complex looks for infinities everywhere.
  const double scale = -0.5 * variance / (m * m);
  const double size = std::exp(scale * (g_squared * (1.0 - det) + turned * trace)) / m;
  const double angle = scale * (turned * (1.0 - det) - g_squared * trace);
  const double c = size * std::cos(angle), s = size * std::sin(angle);
  return {root_real * c + root_imag * s, root_real * s - root_imag * c};
}

std::complex<double> edges_footprint(const FootprintPhase& phase, double spread) {
  const auto widened = [&](double times) { return second_order_footprint(phase, spread * std::sqrt(times)); };
  return 3.0 * (widened(1.0) - widened(2.0)) + widened(3.0);
}

double flat_top_footprint(const FootprintPhase& phase) {
  const auto axis = [](double g) {
    const double loss = 1.0 - std::exp(-g * g / 8.0);  // its fourth power needs no more digits
    return 1.0 - (loss * loss) * (loss * loss);
  };
  return axis(phase.g1) * axis(phase.g2);
}

}  // namespace echopath
