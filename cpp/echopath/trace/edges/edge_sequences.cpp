#include "echopath/trace/edges/edge_sequences.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "echopath/base/geometry.h"

namespace echopath {
namespace {

constexpr double kSamePlane = 1e-6;   // of the extent of all edges, and rad
constexpr double kLeastSlope = 1e-2;  // sine of the angle at which a wave meets an edge, or leaves it

}  // namespace

EdgeSequences::EdgeSequences(std::span<const PosedEdge> edges, double wavelength)
    : edges_(edges), longest_(kLongestFace * wavelength), plane_(edges.size()) {
  find_planes();
}

// Sorts the faces at all edges by a key, so that those on one plane are neighbours.
std::vector<EdgeSequences::OnPlane> EdgeSequences::sorted_faces(const Vec3& middle, double extent) const {
  std::vector<OnPlane> faces;
  for (size_t i = 0; i < edges_.size(); ++i) {
    for (int face = 0; face < 2; ++face) {
      const Vec3& normal = edges_[i].wedge.faces[face].normal;
      const double offset = normal.dot(edges_[i].from - middle);
      faces.push_back({i, face, offset, offset + extent * normal.dot(kSortingDirection), edges_[i].wedge.faces[face].inward,
                       edges_[i].from, edges_[i].line()});
    }
  }
  std::ranges::sort(faces, [](const OnPlane& a, const OnPlane& b) {
    return std::tie(a.key, a.edge, a.face) < std::tie(b.key, b.edge, b.face);
  });
  return faces;
}

void EdgeSequences::find_planes() {
  Box box;
  for (const PosedEdge& edge : edges_) box.extend(edge.from).extend(edge.to);
  const double extent = edges_.empty() ? 0.0 : box.diagonal().norm();
  const std::vector<OnPlane> faces = sorted_faces(edges_.empty() ? Vec3(Vec3::Zero()) : Vec3(box.center()), extent);
  const auto normal = [&](const OnPlane& one) { return edges_[one.edge].wedge.faces[one.face].normal; };
  std::vector<bool> is_taken(faces.size());
  for (size_t i = 0; i < faces.size(); ++i) {
    if (is_taken[i]) continue;
    std::vector<OnPlane>& plane = planes_.emplace_back();
    for (size_t k = i; k < faces.size() && faces[k].key <= faces[i].key + 4.0 * kSamePlane * extent; ++k) {
      const bool is_one = (normal(faces[k]) - normal(faces[i])).norm() < kSamePlane &&
                          std::abs(faces[k].offset - faces[i].offset) < kSamePlane * extent;
      if (is_taken[k] || !is_one) continue;
      is_taken[k] = true;
      plane.push_back(faces[k]);
      plane_[faces[k].edge][faces[k].face] = planes_.size() - 1;
    }
  }
}

// Finds the nearest edge that ends the face toward the direction.
bool EdgeSequences::find_next(size_t edge, int face, const Vec3& position, const Vec3& direction, Met& met) const {
  double nearest = longest_;
  bool is_found = false;
  for (const OnPlane& one : planes_[plane_[edge][face]]) {
    const double slope = direction.dot(one.inward), height = one.inward.dot(position - one.from);
    if (one.edge == edge || slope > -kLeastSlope || height <= 0 || height >= -slope * nearest) continue;
    const Vec3 at = position - height / slope * direction - one.from;
    const double along = at.dot(one.line) / one.line.squaredNorm();
    if (along < 0.0 || along > 1.0) continue;
    nearest = -height / slope;
    met = {one.edge, along};
    is_found = true;
  }
  // Both sides of a sheet carry one wave (MultipleDiffraction).
  return is_found && !(face == 1 && is_rim(edges_[edge].wedge) && is_rim(edges_[met.edge].wedge));
}

void EdgeSequences::follow(size_t edge, const Hit& point, const Vec3& position, const Vec3& in, int most,
                           const Visit& visit) const {
  EdgeSequence sequence{{{edges_[edge].wedge, position}}, {point}};
  extend(sequence, edge, in, most, visit);
}

void EdgeSequences::extend(EdgeSequence& sequence, size_t edge, const Vec3& in, int most, const Visit& visit) const {
  if (std::ssize(sequence.edges) >= most) return;
  const Wedge& wedge = edges_[edge].wedge;
  const Vec3 axis = axis_of(wedge), position = sequence.edges.back().point;
  const double cosine = in.dot(axis), sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
  if (sine < kLeastSlope) return;
  for (int face = 0; face < 2; ++face) {
    const Vec3 direction = cosine * axis + sine * wedge.faces[face].inward;
    Met met;
    if (!find_next(edge, face, position, direction, met)) continue;
    const PosedEdge& next = edges_[met.edge];
    const double along = next.edge.begin + (next.edge.end - next.edge.begin) * met.along;
    const PointOnSide at = point_on_side(next.edge.side, along);
    sequence.edges.push_back({next.wedge, next.from + met.along * (next.to - next.from)});
    sequence.hits.emplace_back(next.mesh_id, next.edge.triangle, at.u, at.v);
    if (visit(sequence, met.edge)) extend(sequence, met.edge, direction, most, visit);
    sequence.edges.pop_back();
    sequence.hits.pop_back();
  }
}

}  // namespace echopath
