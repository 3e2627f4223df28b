#include "echopath/em/footprint.h"

namespace echopath {
namespace {

std::complex<double> complex(const ComplexOf<double>& x) { return {x.re, x.im}; }

}  // namespace

double first_order_footprint(const FootprintPhase& phase) { return first_order_footprint_of<ScalarMath>(phase); }

std::complex<double> second_order_footprint(const FootprintPhase& phase, double spread) {
  return complex(second_order_footprint_of<ScalarMath>(phase, spread));
}

std::complex<double> edges_footprint(const FootprintPhase& phase, double spread) {
  return complex(edges_footprint_of<ScalarMath>(phase, spread));
}

double flat_top_footprint(const FootprintPhase& phase) {
  return flat_top_of<ScalarMath>(phase.g1) * flat_top_of<ScalarMath>(phase.g2);
}

}  // namespace echopath
