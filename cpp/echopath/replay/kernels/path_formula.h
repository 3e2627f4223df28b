#pragma once
// Makes the amplitude of a path from factors of its legs and of the part between them, and bounds of its size. The formula
// stands only here, for doubles and for vectors of doubles (Math as in base/lanes/scalar_math.h). RadioConstants has the
// constants that all paths of a kind share; amplitudes of edges, which the trace estimates too, are made by edge_amplitude
// (em/edges/edge_diffraction.h).
//
// Coherent path: all its bounces are mirror-like, and the last material point radiates by physical optics:
//   a = sqrt(Pt Gt Gr)/(4 pi) * weight * cos_i * F / (sqrt(D) r),   weight = j W Gamma s dS
//   W = product of the coefficients of the bounces before, over the probabilities with which the ray went on there,
//   Gamma = reflection coefficient at the point, s^2 = share of the reflected power that is not scattered,
//   dS = area for which the ray stands (m^2): that of the trace times the area of the triangle over its area then,
//   sqrt(D) = unfolded length TX -> point on flat chains, else sqrt(|T_1 x T_2| cos_i density) of the launch cell,
//   r = unfolded length point -> RX, obliquity cos_i, F the footprint filter (cell_formula.h).
// Diffuse path: one bounce or more scatters, and its power has one random phase phi. S^2 = 1 - s^2; diffuse hits 1..n, legs
// unfolded over what lies between:
//   |a|^2 = Pt Gt/(4 pi) * |weight|^2 * cos_in1/r1^2 * prod [f cos_out cos_in/r^2] * f cos_out_n/r_n^2 * lambda^2 Gr/(4 pi)
//   weight = sqrt(prod dS) prod |Gamma| S * (mirror coefficients) * e^{j phi},   f = 1/pi (Lambert), hence
//   |a| = |weight| sqrt(Pt/pi) lambda/(4 pi) * start * inner * end
//   start, end = sqrt(G |cos|)/r of the legs between the antennas and the first and the last diffuse hit,
//   inner = sqrt(prod dS/dS_trace) * prod sqrt(|cos_out cos_in|/pi)/r over the legs between diffuse hits.
//   Factors carry the signs of their cosines: a surface that is seen from opposite sides makes no echo.
// Flagged mirrors alone: a = weight * lambda sqrt(Pt Gt Gr)/(4 pi L).
// A coherent path without its filter F has at most the amplitude of a mirror in the place of its point, because a cell that
// is wider than a Fresnel zone returns no more.
// In a polarised trace the weight has no coefficients: the matrix J of the path (Paths::jones) has them, and e_r.J e_t with
// the polarisations of transmitter and receiver multiplies the amplitude. Antennas whose tables have a phase turn a
// by e^{j (phase of transmitter + phase of receiver)}. An antenna nearer than kNearAntenna to a material point neither sends
// there nor receives. The phase of the length is not part of the amplitude.
#include "echopath/em/footprint_formula.h"
#include "echopath/em/polarization/transverse_formula.h"
#include "echopath/record/near_antenna.h"
#include "echopath/replay/kernels/cell_formula.h"

namespace echopath {

// Makes every amplitude from the weight of the path (factors/path_weight.h) and the factor of its legs.
template <class Math, class Weight, class Real>
ECHOPATH_INLINE ComplexOf<Real> amplitude_of(ComplexOf<Weight> weight, Real size) {
  return {weight.re * size, weight.im * size};
}
template <class Math, class Weight, class Real>
ECHOPATH_INLINE ComplexOf<Real> amplitude_of(ComplexOf<Weight> weight, ComplexOf<Real> factor) {
  const ComplexOf<Real> scale = amplitude_of<Math>(weight, Real{} + 1.0);
  return {scale.re * factor.re - scale.im * factor.im, scale.re * factor.im + scale.im * factor.re};
}

// --- antennas ---

// Returns the root of AntennaPattern::gain for a whole exponent, of which 0 is a gain all around; root_peak^2 is its peak
// and `cosine` that of the angle from the boresight. It is a formula of its own because the half power needs no root, with
// which to measure a leg at eight nodes takes 38 % longer (16.4 against 11.9 ns, exponent 4, AVX-512).
template <class Math, class Real>
ECHOPATH_INLINE Real root_gain_of(double root_peak, int exponent, Real cosine) {
  Real power = Real{} + root_peak;
  if (exponent == 0) return power;
  for (int i = 0; i < exponent / 2; ++i) power = power * cosine;
  if (exponent % 2) power = power * Math::root(Math::magnitude(cosine));
  return cosine > 0.0 ? power : Real{};
}

// Holds the products of the components of a path's two ends: (rx h, tx h), (rx h, tx v), (rx v, tx h), (rx v, tx v), as in
// JonesMatrix.
template <class Real>
struct PairOfPolarizations {
  Real product[4];

  // The components of both ends are those of departing waves; an arriving wave has the opposite horizontal component.
  ECHOPATH_INLINE PairOfPolarizations(const TransverseOf<Real>& start, const TransverseOf<Real>& end)
      : product{-end.horizontal * start.horizontal, -end.horizontal * start.vertical, end.vertical * start.horizontal,
                end.vertical * start.vertical} {}
  // Returns what the end takes of the wave of the start, e_r.J e_t, where `matrix` has the entries of J, row by row.
  template <class Entry>
  ECHOPATH_INLINE Real through(const Entry* matrix) const {
    return (product[0] * matrix[0] + product[1] * matrix[1]) + (product[2] * matrix[2] + product[3] * matrix[3]);
  }
};

// --- coherent paths ---

// Sets the waves from the signed cosines at the point, of the arrival and of the departure, and from one over the unfolded
// lengths, in 1/m.
template <class Math, class Real>
ECHOPATH_INLINE void set_waves(Real cos_in, Real cos_out, Real inverse_in, Real inverse_out, CellWaves<Real>& waves) {
  waves.cos_in = Math::magnitude(cos_in);
  waves.cos_out = Math::magnitude(cos_out);
  waves.side = Math::with_sign_of(Real{} + 1.0, cos_in);
  waves.inverse_in = inverse_in;
  waves.inverse_out = inverse_out;
}

// Returns whether both antennas see the same side of the surface and neither is near; the lengths are those of the legs to
// both, in m.
template <class Real>
ECHOPATH_INLINE auto is_lit(Real cos_in, Real cos_out, Real first_length, Real last_length) {
  return (cos_in * cos_out > 0.0) & reaches_antenna(first_length) & reaches_antenna(last_length);
}

// Returns 1/sqrt(D), in 1/m; `root_area` is that of the cell on a curved chain, in m sr^-1/2.
template <class Math, class Real>
ECHOPATH_INLINE Real inverse_tube_of(bool is_curved, double root_area, const CellWaves<Real>& waves) {
  return is_curved ? 1.0 / (root_area * Math::root(waves.cos_in)) : waves.inverse_in;
}

// Returns the size of the factor without the filter. `root_gains` is sqrt(Gt Gr), `inverse_tube` is 1/sqrt(D) in 1/m.
template <class Real>
ECHOPATH_INLINE Real coherent_size(Real root_gains, Real cos_in, Real inverse_tube, Real inverse_out) {
  return root_gains * cos_in * inverse_tube * inverse_out;
}

// Returns the least that one over coherent_size can be for gains of 1, whatever the cosine; the unfolded lengths to
// and from the point are at least `in` and `out` (m).
template <class Real>
ECHOPATH_INLINE Real least_spreading(bool is_curved, double root_area, Real in, Real out) {
  return is_curved ? root_area * out : in * out;
}

// Returns the factor of the weight. `is_lit` is what the function is_lit returns.
template <class Real, class Truth>
ECHOPATH_INLINE ComplexOf<Real> coherent_factor(const CellWaves<Real>& waves, Real root_gains, Real inverse_tube,
                                                const ComplexOf<Real>& filter, Truth is_lit) {
  const Real size = coherent_size(root_gains, waves.cos_in, inverse_tube, waves.inverse_out);
  return {is_lit ? size * filter.re : Real{}, is_lit ? size * filter.im : Real{}};
}

// --- flagged mirrors alone ---

// Returns the factor of a path that is `length` (m) long, of which `root_gains` is sqrt(Gt Gr): 0 where the whole path is so
// short that both antennas are near.
template <class Real>
ECHOPATH_INLINE Real mirror_size(Real root_gains, Real length) {
  return reaches_antenna(length) ? root_gains / length : Real{};
}

// --- diffuse paths ---

// Returns the factor of the leg between an antenna and a diffuse hit. `cosine` is signed, at the hit; `inverse` is one over
// the length, in 1/m.
template <class Math, class Real>
ECHOPATH_INLINE Real diffuse_leg(Real root_gain, Real root_cosine, Real cosine, Real length, Real inverse) {
  return reaches_antenna(length) ? Math::with_sign_of(root_gain * root_cosine * inverse, cosine) : Real{};
}
template <class Math, class Real>
ECHOPATH_INLINE Real diffuse_leg(Real root_gain, Real cosine, Real length) {
  return diffuse_leg<Math>(root_gain, Math::root(Math::magnitude(cosine)), cosine, length, 1.0 / length);
}

// Returns the size of the cosine of such a leg from its factor.
template <class Real>
ECHOPATH_INLINE Real cosine_of_leg(Real factor, Real root_gain, Real length) {
  const Real root_cosine = factor * length / root_gain;
  return root_cosine * root_cosine;
}

// Returns the factor of a leg to a specular point, from which it is `to_first` (m) to the first diffuse hit.
template <class Real>
ECHOPATH_INLINE Real specular_leg(Real root_gain, Real length, Real to_first, Real root_cos_first) {
  return reaches_antenna(length) ? root_gain * root_cos_first / (length + to_first) : Real{};
}

// With one diffuse hit, its cosines must have one sign. With several, this must hold at the first hit and at the last.
template <class Math, class Real>
ECHOPATH_INLINE Real diffuse_product(Real start, Real end) {
  return Math::larger(Real{}, start * end);
}
template <class Math, class Real>
ECHOPATH_INLINE Real diffuse_product(Real start, Real end, Real first_sign, Real last_sign) {
  return Math::larger(Real{}, start * first_sign) * Math::larger(Real{}, end * last_sign);
}

}  // namespace echopath
