#include "echopath/em/fresnel.h"

namespace echopath {
namespace {

// The principal root has Re q >= 0, hence Im q <= 0 for a lossy or lossless half space; a tiny permittivity below sin^2
// lies on the cut and decays with Im q < 0.
std::complex<double> transmitted_cosine(std::complex<double> permittivity, double cos_incidence) {
  const std::complex<double> squared = permittivity - (1.0 - cos_incidence * cos_incidence);
  const std::complex<double> root = std::sqrt(squared);
  return root.imag() > 0 ? -root : root;
}

}  // namespace

std::complex<double> fresnel_te(std::complex<double> permittivity, double cos_incidence) {
  const std::complex<double> q = transmitted_cosine(permittivity, cos_incidence);
  return (cos_incidence - q) / (cos_incidence + q);
}

std::complex<double> fresnel_tm(std::complex<double> permittivity, double cos_incidence) {
  const std::complex<double> q = transmitted_cosine(permittivity, cos_incidence);
  return (permittivity * cos_incidence - q) / (permittivity * cos_incidence + q);
}

}  // namespace echopath
