#include "echopath/replay/factors/trace_cells.h"

#include "echopath/replay/evaluate/inner_part.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath {
namespace {

// `hit` is posed; for curved cells it has edges, because the root of their area is needed.
PlacedCell place(const LaunchCell& cell, const CellTangents& tangents, const PosedHit& hit, double density) {
  PlacedCell out;
  out.shape = cell_shape(cell, hit, tangents);
  for (size_t a = 0; a < 2; ++a) out.tangent[a] = tangents[a];
  if (cell.is_curved) out.root_area = root_area(tangents, hit, density);
  return out;
}

}  // namespace

TraceCells::TraceCells(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedPoints& points)
    : plan_(plan), preparer_(preparer), points_(points), images_(images_at_trace(plan, preparer)) {}

double TraceCells::density_of(const SharedLegPlan::ChainPath& chain) const {
  const Paths& paths = preparer_.paths();
  return paths.frame.lattice_density(paths.stratum[chain.path]);
}

const std::array<float, 7>* TraceCells::curved_cell_of(const SharedLegPlan::ChainPath& chain) const {
  return preparer_.paths().curved_cell_of(static_cast<size_t>(chain.path));
}

bool TraceCells::has_cell(const SharedLegPlan::ChainPath& chain) const {
  const Paths& paths = preparer_.paths();
  return paths.is_of_a_ray(static_cast<size_t>(chain.path)) &&
         (curved_cell_of(chain) || paths.frame.footprint != Footprint::kNone);
}

TraceCells::Arrival TraceCells::arrival_of(const SharedLegPlan::ChainPath& chain) const {
  const SharedLegPlan::Leg& start = plan_.legs[chain.start];
  const Vec3 transmitter = mean_antenna_at_trace(preparer_.paths(), false);
  const Vec3 line = points_.traced[start.point].position - images_[start.image].of(transmitter);
  const double length = line.norm();
  if (chain.inner == SharedLegPlan::kNone) return {length, line / length};
  const SharedLegPlan::Inner& inner = plan_.inner[chain.inner];
  std::array<PosedHit, 64> hits;  // a path has no more
  for (size_t k = inner.begin; k < inner.end; ++k) hits[k - inner.begin] = points_.at_trace(plan_.inner_points[k]);
  const InnerPart part = inner_part(path_of(inner), hits.data());
  return {length + part.length, part.last_arrival};
}

// Returns the tangents of the cell of the path's own stratum, on the plane of the surface.
CellTangents TraceCells::flat_tangents(const SharedLegPlan::ChainPath& chain, const PosedHit& hit, double density) const {
  const Arrival arrival = arrival_of(chain);
  const double cos_in = hit.normal.dot(arrival.direction);
  const auto tube = tube_on_plane<ScalarMath>(arrival.length, density, cos_in);
  Vec3 along = arrival.direction - cos_in * hit.normal;
  const double sine = along.norm();
  along = has_plane_of_incidence(sine) ? Vec3(along / sine) : hit.normal.unitOrthogonal();
  return {tube.along * along, tube.across * hit.normal.cross(along)};
}

PlacedCell TraceCells::on_rigid(const SharedLegPlan::ChainPath& chain) const {
  if (!has_cell(chain)) return {};
  const double density = density_of(chain);
  PosedHit hit = points_.at_trace(plan_.legs[chain.end].point);
  CellTangents tangents;
  LaunchCell cell;
  if (const std::array<float, 7>* curved = curved_cell_of(chain)) {
    cell = recorded_cell(*curved);
    PosedHit with_edges;
    pose_facet(preparer_.hit(hit_of(chain)), preparer_.at_trace(), with_edges);
    hit.edge_u = with_edges.edge_u;
    hit.edge_v = with_edges.edge_v;
    tangents = cell_tangents(cell, hit);
  } else {
    tangents = flat_tangents(chain, hit, density);
    cell.is_known = tangents[0].allFinite() && tangents[1].allFinite();
  }
  const uint32_t mesh_id = hit_of(chain).mesh_id;
  cell.facet_area = preparer_.facet_area(mesh_id);
  PlacedCell out = place(cell, tangents, hit, density);
  for (Vec3& tangent : out.tangent) tangent = preparer_.mesh_from_trace(mesh_id) * tangent;
  return out;
}

// Tangents stretch with their triangle, so each node has its own cell.
std::vector<PlacedCell> TraceCells::on_stretching(const SharedLegPlan::ChainPath& chain, const PosedNodes& nodes) const {
  std::vector<PlacedCell> out(nodes.size());
  if (!has_cell(chain)) return out;
  const double density = density_of(chain);
  std::deque<std::array<Vec3, 3>> normals;
  const LocalHit local = preparer_.hit(hit_of(chain), normals);
  PosedHit hit;
  LaunchCell cell;
  if (const std::array<float, 7>* curved = curved_cell_of(chain)) {
    cell = recorded_cell(*curved);
  } else {
    pose_hit(local, preparer_.at_trace(), true, hit);
    const CellTangents tangents = flat_tangents(chain, hit, density);
    for (size_t a = 0; a < 2; ++a) cell.tangent[a] = edge_coordinates(hit.edge_u, hit.edge_v, hit.normal, tangents[a]);
    cell.is_known = cell.tangent[0].allFinite() && cell.tangent[1].allFinite();
  }
  cell.facet_area = preparer_.facet_area(local.mesh_id);
  for (size_t node = 0; node < nodes.size(); ++node) {
    pose_hit(local, nodes.at(node), true, hit);
    out[node] = place(cell, cell_tangents(cell, hit), hit, density);
  }
  return out;
}

}  // namespace echopath
