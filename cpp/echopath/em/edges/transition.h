#pragma once
// Computes the transition function of the uniform theory of diffraction (Kouyoumjian and Pathak 1974), which keeps the field
// of an edge finite at the boundaries of shadow and of reflection.
#include <complex>

namespace echopath {

// Returns F(x) = 2j sqrt(x) e^{jx} times the integral of e^{-jt^2} from sqrt(x)
// on, for x >= 0; 1 far from the boundary. Its error is below 1e-4.
std::complex<double> transition(double x);

}  // namespace echopath
