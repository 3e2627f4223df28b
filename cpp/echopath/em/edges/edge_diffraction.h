#pragma once
// Computes what physical optics leaves out at the edges of perfect conductors: the fringe currents beside an edge.
//
// The currents on both faces of a wedge are those of Sommerfeld's exact solution. Less those of physical optics, they are
// integrated over a strip that begins at the edge and runs along the ray that grazes the face on Keller's cone; the strip
// does not end. Physical optics and the fringe of all edges then count no current twice, and their sum is Keller's
// diffracted field on the cone, in every direction about the edge. It stays finite at the boundaries of shadow and
// reflection. It is not finite along the grazing ray itself (Ufimtsev's singularity), which no backscatter reaches but that
// from the plane of a face. The field of one edge is not cut off where another edge ends the face;
// em/edges/multiple_diffraction.h has what then goes on from edge to edge. Sources: Michaeli 1986, "Elimination of
// infinities in equivalent edge currents, part I: fringe current components"; Mitzner 1974 integrates across the edge
// instead; both agree on the cone (Knott 1985).
#include <array>
#include <complex>
#include <optional>

#include "echopath/base/geometry.h"
#include "echopath/em/edges/face_currents.h"

namespace echopath {

// Describes a wedge by its faces and the angle of the space around it, in (0, 2 pi] rad: 2 pi at the rim of a sheet, whose
// faces differ by their normals, 1.5 pi at the edge of a box.
struct Wedge {
  WedgeFace faces[2];
  double exterior_angle;
};

// Returns the wedge of two faces that end at one edge, with the space between their outsides; of both faces of one sheet,
// its rim.
Wedge wedge_between(const WedgeFace& first, const WedgeFace& second);

// Returns whether a wedge is the rim of a sheet, both of whose faces carry one wave.
bool is_rim(const Wedge& wedge);

// Returns the unit vector along the edge about which the angles of the wedge count.
Vec3 axis_of(const Wedge& wedge);

// Returns whether a unit vector from the edge leads into the space around the wedge.
bool is_outside(const Wedge& wedge, const Vec3& direction);

// Holds what a wave that travels along the unit vector `in` determines of the fringe of an edge. toward() returns the real
// matrix M, with which a wave of the field E makes the field -j/(2 k) M E, across the unit vector `out`, that takes the
// place of Gamma K E of physical optics (surface_response.h) times an area: it counts per metre of the edge, in m. M is zero
// inside of the wedge, for a flat wedge, and within 1e-3 rad of the edge's own direction, along which the coefficient is not
// defined.
class Fringe {
 public:
  Fringe(const Wedge& wedge, const Vec3& in);
  Mat3 toward(const Vec3& out) const;

 private:
  Wedge wedge_;
  std::optional<std::array<FaceCurrents, 2>> faces_;  // none: M is zero
};

// Returns the matrix of one wave toward one direction.
inline Mat3 fringe_matrix(const Wedge& wedge, const Vec3& in, const Vec3& out) { return Fringe(wedge, in).toward(out); }

// Returns the amplitude of the echo of a piece of an edge that is `piece` (m) long, at the distances `in` and `out` (m) from
// both antennas. `field` is sqrt(Pt Gt Gr)/(4 pi) times what M couples from one antenna to the other.
inline double edge_amplitude(double field, double piece, double wavenumber, double in, double out) {
  return field * piece / (2.0 * wavenumber * in * out);
}

// Returns the vector V of what the wedge makes of a wave that travels along one of its faces (0 or 1) toward the edge, in
// the direction `along`, with a field of unit strength across the face. Its field -j/(2 k) V per metre of the edge is the
// whole diffracted field: the wave ends at the edge, and physical optics knows nothing of it. V is not finite where `out` is
// the wave's own direction.
Vec3 field_of_grazing_wave(const Wedge& wedge, int face, const Vec3& along, const Vec3& out);

// Returns Keller's coefficient of a wedge for a magnetic field along the edge, over e^{-j pi/4}/sqrt(2 pi k), from the angle
// of the source to another one about the edge (rad, from its first face). It is not finite at the boundaries of shadow and
// of reflection.
double grazing_coefficient(double exterior_angle, double source, double at);

// Returns the angle about the edge from the first face to a direction outside, in [0, exterior_angle] rad.
double angle_about(const Wedge& wedge, const Vec3& direction);

// Returns the share of a straight piece of an edge: the mean of e^{-j(x s + b s^2)} over s in [-1, 1], where phases grow by
// `linear_phase` = 2x (rad) along the piece and are `quadratic_phase` = b (rad) ahead at its ends, as of spherical waves. It
// is exact to the second order in b: within 1.3 % of a piece where b is at most 0.8.
std::complex<double> edge_filter(double linear_phase, double quadratic_phase);

}  // namespace echopath
