#pragma once
// Measures a surface as a mirror between two points: how much of the Fresnel zone it covers, and what its edges leave of the
// field.
#include <array>
#include <complex>
#include <span>

#include "echopath/posed/posed_antenna.h"
#include "echopath/trace/geometry/surface_extent.h"

namespace echopath {

// Describes a specular bounce: the point, the unit direction in which the wave arrives there, and the unfolded lengths in m
// from the source (`before`) and to the point that is lit (`behind`).
struct MirrorView {
  const RayHit& point;
  Vec3 arrival;
  double before, behind;
};

// Describes an antenna at an end of a path as a bounce sees it: behind all planes between both.
struct UnfoldedAntenna {
  const PosedAntenna& antenna;
  Vec3 place;              // m, of its image, relative to the point of the bounce
  Mat3 antenna_from_here;  // takes directions at the bounce to those at the antenna, both in world axes

  // Returns its gain toward a place that is `shift` (m) beside the point.
  AntennaGain toward(const Vec3& shift) const { return antenna.toward(antenna_from_here * (shift - place).normalized()); }
};
using UnfoldedAntennas = std::array<UnfoldedAntenna, 2>;  // where the wave comes from, and where it goes

// Describes one of the two axes of the zone, in the plane of incidence and across it.
struct ZoneAxis {
  Vec3 along;           // unit, tangent to the surface
  double half = 0.0;    // m: a wave over a point so far off comes half a wavelength later
  double spread = 1.0;  // of the tube of rays behind the bounce, over that behind a flat mirror
};
std::array<ZoneAxis, 2> zone_axes(const MirrorView& view, double wavelength);

struct ZoneCover {
  double share = 1.0;                // of the zone's extents, product of both axes, at most 1
  std::complex<double> field = 1.0;  // field that the edges leave, over that of an endless mirror
};

// Describes the surface that the wave lights behind the mirror.
struct ZoneTarget {
  const RayHit& point;
  Vec3 arrival;  // unit
};

// Returns the share of the zone that the surface around a facet's point covers and, with a `target` (the surface that the
// wave lights), the field that reaches it.
//
// The field is Kirchhoff's integral over the mirror by stationary phase: for each axis F(a) + F(b) - 1, with a and b the
// distances to its edges in half zones and F the field behind a straight edge (Born and Wolf, "Principles of Optics", 8.7).
// The inside of a corner is no edge, because the images of a wedge of 90 degrees have none; but between two walls the
// surface goes on only beyond one that rises to where the waves to and from the zone behind it cross it. What an edge takes
// from the lit part of a flat target it adds beyond the shadow boundary, with the same phase; so the edge counts as none
// where the target goes on as far beyond as the point lies within. A surface that is wider than the zone by kAmple counts
// as endless, so that closed forms of large corners (geometrical optics up to the last surface) hold; between that and the
// zone's width the edges come in gradually. This is valid where the surface is flat over the zone and its edges run about
// along the axes.
ZoneCover cover_of_zone(const EmbreeScene& geometry, const MirrorView& view, const ZoneTarget* target, double wavelength,
                        int64_t& num_queries);

// Returns the width in m of cracks along the inside of a corner that count as none, as between a road and a house of another
// model.
double widest_crack(const MirrorView& view, double wavelength);

// Returns the field that a flat mirror sends to a point over that of an endless one; e^{+jwt}.
//
// It is Kirchhoff's integral by stationary phase in polar coordinates about the point of reflection, 1 - <exp(-j pi r^2)>:
// r is the distance to the mirror's edge in half zones, and the mean is over all directions, between which edges are
// followed, straight or round. Where the mirror ends at the inside of a corner of 90, 60 or 45 degrees it has no edge, and
// of a wave that goes on to a plane that it has a corner with (`next`, which may be null) that plane has it. Where the
// mirror bends by however little, it has one: the plane behind has echoes of its own, by its image or by rays, with which
// those of this plane add up. It has one where a plane stands on it from which the wave comes (one of `met`), too: that
// plane lights nothing of what goes on behind it. An edge counts by the field with which the antennas light and hear it,
// over that of the point, by as much as the point at most: a narrow beam that ends before the edge has none. Edges fade
// between 8 and 16 half zones, so that closed forms of geometrical optics hold beyond. Of the endless mirror's field it is
// right to 1.6 % in polygons of up to 8 sides, to 7 % in those of more and in disks, and to 5 % beside bends and corners,
// where geometrical optics is wrong by up to all of it. This is valid where no line from the point meets the edge twice.
std::complex<double> field_of_flat_mirror(const EmbreeScene& geometry, const MirrorView& view, double wavelength,
                                          const UnfoldedAntennas& antennas, int64_t& num_queries, std::span<const Plane> met,
                                          const Plane* next);

// Returns the field `within` half zones inside the shadow boundary of a straight edge, over that without the edge; e^{+jwt}.
std::complex<double> field_beside_edge(double within);

}  // namespace echopath
