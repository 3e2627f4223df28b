#include "echopath/replay/trace_cells.h"

#include <cmath>

#include "echopath/replay/inner_part.h"

namespace echopath {

TraceCells::TraceCells(const ChainPlan& plan, const Localiser& localise, const PosedPoints& points)
    : plan_(plan), localise_(localise), points_(points), origin_{Vec3::Zero()} {
  for (size_t image = 1; image < plan.images.size(); ++image) {
    PosedHit mirror;
    pose_hit(localise.hit(plan.mirrors[plan.images[image].mirror]), localise.trace_instant(), false, mirror);
    const Vec3& from = origin_[plan.images[image].parent];
    origin_.push_back(from - 2.0 * mirror.normal.dot(from - mirror.point) * mirror.normal);
  }
}

TraceCells::Arrival TraceCells::arrival_of(const ChainPlan::Chain& chain) const {
  const ChainPlan::Leg& start = plan_.legs[chain.start];
  const Vec3 line = points_.traced[start.point].position - origin_[start.image];
  const double length = line.norm();
  if (chain.inner == ChainPlan::kNone) return {length, line / length};
  const ChainPlan::Inner& inner = plan_.inner[chain.inner];
  std::array<PosedHit, 64> hits;  // a path has no more
  for (size_t k = inner.begin; k < inner.end; ++k) hits[k - inner.begin] = points_.at_trace(plan_.inner_points[k]);
  const InnerPart part = inner_part(path_of(inner), hits.data());
  return {length + part.length, part.last_arrival};
}

// Of the cell of the path's own stratum, on the plane of the surface.
CellTangents TraceCells::flat_tangents(const ChainPlan::Chain& chain, const PosedHit& hit, double density) const {
  const Arrival arrival = arrival_of(chain);
  const double cos_in = hit.normal.dot(arrival.direction), side = arrival.length / std::sqrt(density);  // of the tube, m
  Vec3 along = arrival.direction - cos_in * hit.normal;
  const double sine = along.norm();
  along = sine > 1e-9 ? Vec3(along / sine) : hit.normal.unitOrthogonal();
  return {along * (side / std::max(std::abs(cos_in), 1e-3)), hit.normal.cross(along) * side};
}

RigidCell TraceCells::operator()(const ChainPlan::Chain& chain) const {
  const Paths& paths = localise_.paths();
  const auto p = static_cast<size_t>(chain.path);
  const size_t stratum = paths.stratum[p];
  RigidCell out;
  if (stratum >= paths.frame.strata.size()) return out;
  const uint32_t point = plan_.legs[chain.end].point;
  const double density = paths.frame.lattice_density(stratum);
  PosedHit hit = points_.at_trace(point);
  CellTangents tangents;
  LaunchCell cell;
  if (!paths.curved_cell.empty() && paths.curved_cell[p] != std::array<float, 7>{}) {
    cell = recorded_cell(paths.curved_cell[p], density);
    PosedHit with_edges;
    pose_facet(localise_.hit(plan_.points[point]), localise_.trace_instant(), with_edges);
    hit.edge_u = with_edges.edge_u;
    hit.edge_v = with_edges.edge_v;
    tangents = cell_tangents(cell, hit);
    out.root_area = std::sqrt(tangents[0].cross(tangents[1]).norm() * density);
  } else {
    if (paths.frame.footprint == Footprint::kNone) return out;
    tangents = flat_tangents(chain, hit, density);
    cell.is_known = tangents[0].allFinite() && tangents[1].allFinite();
  }
  cell.facet_area = localise_.facet_area(plan_.points[point].mesh_id);
  out.shape = cell_shape(cell, hit, tangents);
  for (size_t a = 0; a < 2; ++a) out.tangent[a] = localise_.mesh_from_trace(plan_.points[point].mesh_id) * tangents[a];
  return out;
}

}  // namespace echopath
