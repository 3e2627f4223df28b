#include "echopath/em/edges/multiple_diffraction.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kInFace = 1e-3;    // rad: a way between two points on a face leaves its plane by less
constexpr double kSameFace = 1e-6;  // of the cosine between normals of one face
constexpr double kBeside = 1e-4;    // rad: directions nearer to the way itself count as that far off its face

// Returns a direction that is not that of the way, toward which coefficients are not finite.
Vec3 beside(const Vec3& direction, const Vec3& along, const Vec3& normal) {
  if ((direction - along).squaredNorm() > kBeside * kBeside) return direction;
  return (along + kBeside * normal).normalized();
}

// Returns the direction on Keller's cone about the way `along` at the angle of `in` about the edge, on which alone
// coefficients depend. Antennas of an array, and those that have moved since the trace, see the edge from beside that cone.
Vec3 on_cone(const Vec3& in, const Vec3& along, const Vec3& edge) {
  const double cosine = along.dot(edge), sine = along.cross(edge).norm();
  const Vec3 across = in - in.dot(edge) * edge;
  return cosine * edge + sine * across.stableNormalized();
}

// Returns the row that makes from an incident field the strength of the wave along a face, over the factor of its spread.
// `coefficient` is grazing_coefficient.
Vec3 strength_row(const Wedge& wedge, const Vec3& in, const Vec3& along, const Vec3& normal, double coefficient) {
  const Vec3 edge = axis_of(wedge);
  const double cosine = along.dot(edge), sine = std::sqrt(std::max(1.0 - cosine * cosine, 1e-12));
  return coefficient / (sine * along.cross(normal).dot(edge)) * edge.cross(in);
}

double angle_of_face(const Wedge& wedge, int face) { return face == 0 ? 0.0 : wedge.exterior_angle; }

}  // namespace

std::optional<MultipleDiffraction> MultipleDiffraction::over(std::span<const DiffractingEdge> edges, double wavenumber) {
  MultipleDiffraction multiple(edges, wavenumber);
  for (size_t k = 0; k + 1 < edges.size(); ++k) {
    if (!multiple.add_link(edges[k], edges[k + 1])) return std::nullopt;
    if (k > 0) multiple.between_ *= multiple.turn(k) * multiple.spread(multiple.links_[k]);
  }
  return multiple;
}

bool MultipleDiffraction::add_link(const DiffractingEdge& first, const DiffractingEdge& second) {
  const Vec3 line = second.point - first.point;
  const double length = line.norm();
  const Vec3 along = line / length;
  for (int to = 0; to < 2; ++to) {
    for (int from = 0; from < 2; ++from) {
      const WedgeFace &a = first.wedge.faces[from], &b = second.wedge.faces[to];
      const bool is_one = a.normal.dot(b.normal) > 1.0 - kSameFace && std::abs(along.dot(a.normal)) < kInFace;
      if (!is_one || along.dot(a.inward) < kInFace || -along.dot(b.inward) < kInFace) continue;
      const double share = is_rim(first.wedge) && is_rim(second.wedge) ? 1.0 : 0.5;
      links_.push_back({along, b.normal, length, from, to, share});
      length_ += length;
      return true;
    }
  }
  return false;
}

// Returns the spread of a cylindrical wave from the edge, e^{-j pi/4}/sqrt(2 pi k r).
std::complex<double> MultipleDiffraction::spread(const Link& link) const {
  return std::polar(1.0 / std::sqrt(kTwoPi * wavenumber_ * link.length), -0.25 * kPi);
}

// Returns what the edge before a link makes of the wave that arrives on the link before it.
std::complex<double> MultipleDiffraction::turn(size_t link) const {
  const Link &before = links_[link - 1], &behind = links_[link];
  const Wedge& wedge = edges_[link].wedge;
  const double coefficient =
      grazing_coefficient(wedge.exterior_angle, angle_of_face(wedge, before.to), angle_of_face(wedge, behind.from));
  // The next face may lie nearly in the wave's own direction.
  const double apart = before.length * behind.length / (before.length + behind.length);
  const std::complex<double> shadow = transition(wavenumber_ * apart * (1.0 - before.along.dot(behind.along)));
  return before.share * shadow *
         strength_row(wedge, before.along, behind.along, behind.normal, coefficient).dot(before.normal);
}

Vec3 MultipleDiffraction::last_piece(const Vec3& first_piece) const {
  Vec3 piece = first_piece;
  for (size_t k = 0; k < links_.size(); ++k) {
    const Vec3 across = links_[k].normal.cross(links_[k].along), edge = axis_of(edges_[k + 1].wedge);
    piece = piece.dot(across) / edge.dot(across) * edge;
  }
  return piece;
}

double MultipleDiffraction::detour(const Vec3& in, double distance) const {
  const Vec3 edge = axis_of(edges_[0].wedge);
  const double slope = (in - links_[0].along).dot(edge), sine2 = in.cross(edge).squaredNorm();
  return sine2 > 1e-6 ? -0.5 * slope * slope / (sine2 * (1.0 / distance + 1.0 / length_)) : 0.0;
}

FieldVector MultipleDiffraction::enter(const Vec3& in, double distance) const {
  const Link& link = links_.front();
  const Wedge& wedge = edges_.front().wedge;
  const Vec3 travel = beside(on_cone(in, link.along, axis_of(wedge)), link.along, -link.normal);
  const double coefficient =
      grazing_coefficient(wedge.exterior_angle, angle_about(wedge, -travel), angle_of_face(wedge, link.from));
  const Vec3 row = strength_row(wedge, in, link.along, link.normal, coefficient);
  const double apart = link.length * distance / (link.length + distance);
  const std::complex<double> shadow = transition(wavenumber_ * apart * (1.0 - travel.dot(link.along)));
  const double of_sphere = std::sqrt(distance / (distance + length_));
  return of_sphere * shadow * spread(link) * between_ * row.cast<std::complex<double>>();
}

FieldVector MultipleDiffraction::leave(const Vec3& out, double distance) const {
  const Link& link = links_.back();
  const Vec3 departure = beside(out, link.along, link.normal);
  const double apart = link.length * distance / (link.length + distance);
  const std::complex<double> shadow = transition(wavenumber_ * apart * (1.0 - departure.dot(link.along)));
  return link.share * shadow *
         field_of_grazing_wave(edges_.back().wedge, link.to, link.along, departure).cast<std::complex<double>>();
}

}  // namespace echopath
