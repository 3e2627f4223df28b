#pragma once
// Computes what one hit makes of the two modes of a wave (TE, TM), in the horizontal and vertical components of what leaves
// it (em/polarization/jones.h says what is modelled). The formulas are for doubles and can be inlined into loops over lanes.
#include "echopath/base/lanes/scalar_math.h"
#include "echopath/base/vector_of.h"

namespace echopath {

inline constexpr double kMinSine = 1e-9;  // two directions at a smaller sine have no plane of their own

// Holds two unit vectors across a direction of travel; horizontal x vertical points along it.
struct BasisAcross {
  VectorOf<double> horizontal, vertical;
};
ECHOPATH_INLINE BasisAcross basis_across(const VectorOf<double>& direction) {
  const double sine = ScalarMath::root(direction.x * direction.x + direction.y * direction.y);
  const bool is_level = sine > kMinSine;
  const double inverse = 1.0 / (is_level ? sine : 1.0);
  const VectorOf<double> horizontal{is_level ? -inverse * direction.y : ScalarMath::with_sign_of(1.0, direction.z),
                                    is_level ? inverse * direction.x : 0.0, 0.0};
  return {horizontal, cross(direction, horizontal)};
}

// Holds unit vectors along the fields of both modes of a wave that meets a surface: te = direction x normal, tm = te x
// direction. At normal incidence any plane serves, and te is horizontal.
struct ModeAxes {
  VectorOf<double> te, tm;
};
ECHOPATH_INLINE ModeAxes mode_axes(const VectorOf<double>& direction, const VectorOf<double>& normal) {
  const VectorOf<double> across = cross(direction, normal), level = basis_across(direction).horizontal;
  const double sine = ScalarMath::root(dot(across, across));
  const bool is_oblique = sine > kMinSine;
  const double inverse = 1.0 / (is_oblique ? sine : 1.0);
  const VectorOf<double> te{is_oblique ? inverse * across.x : level.x, is_oblique ? inverse * across.y : level.y,
                            is_oblique ? inverse * across.z : level.z};
  return {te, cross(te, direction)};
}

// Maps the components TE and TM to those along h and v.
struct HitMatrix {
  ComplexOf<double> h_te, h_tm, v_te, v_tm;
};

// Describes where a wave that hits a surface comes from and goes to.
struct HitGeometryOfModes {
  VectorOf<double> direction, normal, out;  // unit; the normal on the lit side
  ModeAxes modes;                           // of `direction`
  BasisAcross across;                       // across `out`
};
ECHOPATH_INLINE HitGeometryOfModes hit_geometry(const VectorOf<double>& direction, const VectorOf<double>& normal,
                                                const VectorOf<double>& out) {
  return {direction, normal, out, mode_axes(direction, normal), basis_across(out)};
}

// Evaluates physical optics, -(1/2) out x [n x E_t - out x (n x H_t)], for unit fields along TE and TM. For TE the electric
// part goes with (1 + Gamma) and the magnetic part with cos_i (1 - Gamma); for TM they change places, with its own Gamma.
ECHOPATH_INLINE HitMatrix radiated_modes(const HitGeometryOfModes& hit, ComplexOf<double> te, ComplexOf<double> tm) {
  const double cosine = -dot(hit.direction, hit.normal);
  const VectorOf<double> along = cross(hit.normal, hit.modes.te);
  const double ht = dot(hit.across.horizontal, hit.modes.te), vt = dot(hit.across.vertical, hit.modes.te);
  const double hw = dot(hit.across.horizontal, along), vw = dot(hit.across.vertical, along);
  const auto mixed = [](double sum_part, double difference_part, ComplexOf<double> gamma) {
    return ComplexOf<double>{-0.5 * (sum_part * (1.0 + gamma.re) + difference_part * (1.0 - gamma.re)),
                             -0.5 * (sum_part - difference_part) * gamma.im};
  };
  return {mixed(-vw, cosine * ht, te), mixed(hw, cosine * vt, tm), mixed(hw, cosine * vt, te), mixed(vw, -cosine * ht, tm)};
}

// A metal facet that mirrors `direction` into `out` turns TE to (cosine, sine) of (h, v), TM to (-sine, cosine).
struct FacetTurn {
  double cosine, sine;
};
ECHOPATH_INLINE FacetTurn facet_turn(const HitGeometryOfModes& hit) {
  const double ahead = dot(hit.direction, hit.out);
  // Finite: `out` is on the lit side, `direction` comes from there.
  const double onto = dot(hit.out, hit.modes.te) / (1.0 - ahead);
  const VectorOf<double>& k = hit.direction;
  return {-(dot(k, hit.across.horizontal) * onto + dot(hit.across.horizontal, hit.modes.te)),
          -(dot(k, hit.across.vertical) * onto + dot(hit.across.vertical, hit.modes.te))};
}

// Holds the axis across `direction` at an angle from the normal of the scattering plane, in components along TE and TM.
struct AxisInModes {
  double te, tm;
};
ECHOPATH_INLINE AxisInModes scattering_axis(const HitGeometryOfModes& hit, double cosine, double sine) {
  const double along = dot(hit.out, hit.modes.te), beside = dot(hit.out, hit.modes.tm);
  const double size = ScalarMath::root(along * along + beside * beside);
  const bool has_plane = size > kMinSine;
  const double inverse = 1.0 / (has_plane ? size : 1.0);
  const double te = has_plane ? inverse * beside : 1.0, tm = has_plane ? -inverse * along : 0.0;
  return {cosine * te + sine * tm, cosine * tm - sine * te};
}

// Splits a wave into one that stays as it is and one that is mirrored at an axis, in quadrature (em/polarization/jones.h,
// scattered_field).
struct ModeMixing {
  double kept = 1.0, turned = 0.0;  // square roots of the shares of power
};

ECHOPATH_INLINE ModeMixing mixing_of(double cross_share) {
  return {ScalarMath::root(1.0 - 2.0 * cross_share), ScalarMath::root(2.0 * cross_share)};
}

// Evaluates diffuse scattering; `reflection` is the magnitude of the field that is left.
ECHOPATH_INLINE HitMatrix scattered_modes(const HitGeometryOfModes& hit, double reflection, const ModeMixing& mixing,
                                          const AxisInModes& axis) {
  const FacetTurn turn = facet_turn(hit);
  const double cosine = reflection * turn.cosine, sine = reflection * turn.sine, kept = mixing.kept;
  // (kept - j turned) + 2 j turned axis axis^T
  const double te_te = mixing.turned * (2.0 * axis.te * axis.te - 1.0),
               tm_tm = mixing.turned * (2.0 * axis.tm * axis.tm - 1.0);
  const double te_tm = 2.0 * mixing.turned * axis.te * axis.tm;
  return {{cosine * kept, cosine * te_te - sine * te_tm},
          {-sine * kept, cosine * te_tm - sine * tm_tm},
          {sine * kept, sine * te_te + cosine * te_tm},
          {cosine * kept, sine * te_tm + cosine * tm_tm}};
}

}  // namespace echopath
