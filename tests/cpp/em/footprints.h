#pragma once
// Footprint filters of one phase.
#include <complex>

#include "echopath/em/footprint_formula.h"

namespace echopath::testing {

using FootprintPhase = FootprintPhaseOf<double>;

inline double first_order(const FootprintPhase& phase) { return first_order_footprint_of<ScalarMath>(phase); }

inline std::complex<double> second_order(const FootprintPhase& phase, double spread) {
  const ComplexOf<double> found = second_order_footprint_of<ScalarMath>(phase, spread);
  return {found.re, found.im};
}

inline double flat_top(const FootprintPhase& phase) {
  return flat_top_of<ScalarMath>(phase.g1) * flat_top_of<ScalarMath>(phase.g2);
}

}  // namespace echopath::testing
