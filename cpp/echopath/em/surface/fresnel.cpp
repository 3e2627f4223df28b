#include "echopath/em/surface/fresnel.h"

#include <cmath>

namespace echopath {
namespace {

// Returns the principal square root of a number far from the ends of the range of double.
std::complex<double> principal_root(std::complex<double> squared) {
  const double size = std::sqrt(std::norm(squared));
  const double larger = std::sqrt(0.5 * (size + std::abs(squared.real())));  // of the root's two parts
  if (larger == 0) return 0.0;
  const double smaller = 0.5 * squared.imag() / larger;
  if (squared.real() >= 0) return {larger, smaller};
  return {std::abs(smaller), std::copysign(larger, smaller)};
}

std::complex<double> te_of(std::complex<double> q, double cos_incidence) {
  return (cos_incidence - q) / (cos_incidence + q);
}

std::complex<double> tm_of(std::complex<double> q, std::complex<double> permittivity, double cos_incidence) {
  return (permittivity * cos_incidence - q) / (permittivity * cos_incidence + q);
}

}  // namespace

// The principal root has Re q >= 0, hence Im q <= 0 for a lossy or lossless half space. The root of a permittivity below
// sin^2 lies on the branch cut, where a wave that decays has Im q < 0.
std::complex<double> transmitted_cosine(std::complex<double> permittivity, double cos_incidence) {
  const std::complex<double> squared = permittivity - (1.0 - cos_incidence * cos_incidence);
  const std::complex<double> root = principal_root(squared);
  return root.imag() > 0 ? -root : root;
}

std::complex<double> fresnel_te(std::complex<double> permittivity, double cos_incidence) {
  return te_of(transmitted_cosine(permittivity, cos_incidence), cos_incidence);
}

std::complex<double> fresnel_tm(std::complex<double> permittivity, double cos_incidence) {
  return tm_of(transmitted_cosine(permittivity, cos_incidence), permittivity, cos_incidence);
}

FresnelModes fresnel_modes(std::complex<double> permittivity, double cos_incidence) {
  const std::complex<double> q = transmitted_cosine(permittivity, cos_incidence);
  return {te_of(q, cos_incidence), tm_of(q, permittivity, cos_incidence)};
}

}  // namespace echopath
