#pragma once
// Follows what runs along flat faces from edge to edge: diffraction of higher order.
//
// The field beside a conductor whose magnetic part lies along the edges runs along a face as a wave that is bound to no
// other condition than the face; the other polarisation vanishes there, to this order. From each edge the wave leaves along
// the ray that grazes the next face on Keller's cone, and there it is half of what a wave from afar would be, because it
// counts as incident and reflected. At both ends of the sequence, where the antenna may look along the face, transition
// functions keep the field finite. Sources: Keller 1962, "Geometrical theory of diffraction"; Kouyoumjian and Pathak 1974
// (transition function, grazing incidence); Michaeli 1987, "Equivalent currents for second-order diffraction by the edges of
// perfectly conducting polygonal surfaces" (strips from edge to edge); Ross 1966 (plates).
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "echopath/em/edges/edge_diffraction.h"
#include "echopath/em/edges/transition.h"
#include "echopath/em/polarization/jones.h"

namespace echopath {

// Holds a point on an edge and the wedge there.
struct DiffractingEdge {
  Wedge wedge;
  Vec3 point;  // m
};

class MultipleDiffraction {
 public:
  // Returns the diffraction over two edges or more, in the order of travel; nothing where two that follow each other do not
  // end one flat face that reaches from point to point.
  static std::optional<MultipleDiffraction> over(std::span<const DiffractingEdge> edges, double wavenumber);

  // Returns the way from the first point to the last, m.
  double length() const { return length_; }
  // Returns the direction of travel at the last edge, unit.
  const Vec3& arrival() const { return links_.back().along; }
  // Returns the piece of the last edge that the waves reach from a piece of the first one.
  Vec3 last_piece(const Vec3& first_piece) const;
  // Returns by how much the shortest way over the first edge is longer than that over its point (m, not positive) for a wave
  // that arrives in the direction `in` from an antenna at a distance (m): where it is not the wave for which the points lie
  // on Keller's cone.
  double detour(const Vec3& in, double distance) const;
  // Returns the row that makes of a field which arrives at the first edge along `in` from a distance (m) the strength of its
  // wave across the last face, where it arrives there. The phase of the way is left out.
  FieldVector enter(const Vec3& in, double distance) const;
  // Returns the vector V of what leaves the last edge toward `out` to a distance (m): -j/(2 k) V per metre of that edge for
  // a unit strength, as fringe_matrix has it.
  FieldVector leave(const Vec3& out, double distance) const;

 private:
  struct Link {
    Vec3 along, normal;  // unit, of travel and of the face
    double length;       // m
    int from, to;        // faces of both wedges
    double share;        // of a wave from afar: 1/2, or 1 of both sides of a sheet
  };

  MultipleDiffraction(std::span<const DiffractingEdge> edges, double wavenumber)
      : edges_(edges.begin(), edges.end()), wavenumber_(wavenumber) {}
  bool add_link(const DiffractingEdge& first, const DiffractingEdge& second);
  std::complex<double> spread(const Link& link) const;
  std::complex<double> turn(size_t link) const;

  std::vector<DiffractingEdge> edges_;
  std::vector<Link> links_;
  double wavenumber_, length_ = 0.0;    // rad/m, m
  std::complex<double> between_ = 1.0;  // from the strength on the first face to that on the last
};

}  // namespace echopath
