#include "echopath/replay/posed/local_paths.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "echopath/replay/kernels/cell_formula.h"
#include "echopath/scene/smooth/kept_normals.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath {
namespace {

// Returns the lobes by mesh ID, or nothing where those of all these meshes are Lambert's.
std::vector<DiffuseLobe> lobes_of(const Scene& scene, std::span<const uint32_t> mesh_ids) {
  std::vector<DiffuseLobe> lobes;
  const auto lobe = [&](uint32_t id) { return DiffuseLobe(*scene.node_of(id).material); };
  if (std::ranges::all_of(mesh_ids, [&](uint32_t id) { return lobe(id).is_lambert(); })) return lobes;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) lobes.push_back(lobe(id));
  return lobes;
}

// Returns the specular hits before the last material point that are not replayed by images.
uint64_t sliding_hits(const LocalPath& path) {
  uint64_t sliding = 0;
  for (int k = 0; k < path.last_material; ++k) {
    if (!path.is_image(k) && !path.is_diffuse(k) && !path.is_edge(k)) sliding |= uint64_t{1} << k;
  }
  return sliding;
}

}  // namespace

PathPreparer::PathPreparer(const Paths& paths, MeshesToPose meshes)
    : paths_(paths), meshes_(std::move(meshes)),
      at_trace_(*paths.scene, paths.radar, meshes_, paths.frame.transmitter, paths.frame.trace_time),
      smooth_normals_(paths.scene->meshes().size()), lobes_(lobes_of(*paths.scene, meshes_.places->meshes)) {
  if (paths.frame.edges) edges_.emplace(*paths.scene);
  for (const uint32_t id : meshes_.places->meshes) {
    of_meshes_.push_back(mesh_at_trace(id));
    smooth_normals_[id] = normals_at_trace(id);
  }
}

PathPreparer::MeshAtTrace PathPreparer::mesh_at_trace(uint32_t mesh_id) const {
  const Node& node = paths_.scene->node_of(mesh_id);
  return {shape_at_trace(mesh_id),
          node.material->mirror,
          paths_.scene->may_stretch(mesh_id),
          !node.smooth && !node.deformation,
          at_trace_.linear(mesh_id).inverse(),
          facet_area_at_trace(mesh_id)};
}

bool PathPreparer::meets_lobe(int64_t path) const {
  const Hit* hits = paths_.hits_of(path);
  for (uint64_t diffuse = paths_.diffuse[path]; diffuse != 0; diffuse &= diffuse - 1) {
    if (!lobes_[hits[std::countr_zero(diffuse)].mesh_id].is_lambert()) return true;
  }
  return false;
}

double PathPreparer::facet_area_at_trace(uint32_t mesh_id) const {
  const Node& node = paths_.scene->node_of(mesh_id);
  if (node.smooth || (node.mesh->is_flat() && !node.deformation)) return kNoFacets;
  const double at_rest = node.mesh->area() / static_cast<double>(node.mesh->triangles().size());
  return at_rest * std::pow(std::abs(at_trace_.linear(mesh_id).determinant()), 2.0 / 3.0);
}

NormalsOfMeshes::value_type PathPreparer::normals_at_trace(uint32_t mesh_id) const {
  const Node& node = paths_.scene->node_of(mesh_id);
  if (!node.smooth) return nullptr;
  if (!node.deformation) return kept_vertex_normals(node.mesh);
  std::vector<Vec3> normals;
  for (const uint32_t place : meshes_.patches[mesh_id].place) {
    const bool is_posed = place != SurfacePatch::kAbsent;
    normals.push_back(is_posed ? at_trace_.deformed_normals(mesh_id)[place] : Vec3(Vec3::Zero()));
  }
  if (normals.empty()) return nullptr;
  return std::make_shared<const std::vector<Vec3>>(std::move(normals));
}

PathPreparer::Shape PathPreparer::shape_at_trace(uint32_t mesh_id) const {
  const Node& node = paths_.scene->node_of(mesh_id);
  const bool deforms = node.deformation != nullptr;
  return {node.mesh->triangles().data(), (deforms ? at_trace_.local_vertices(mesh_id) : node.mesh->vertices()).data(),
          deforms};
}

LocalHit PathPreparer::hit(const Hit& hit) const {
  const MeshAtTrace& mesh = at(hit.mesh_id);
  const Shape& shape = mesh.shape;
  const Triangle& triangle = shape.triangles[hit.triangle_id];
  LocalHit local;
  local.mesh_id = hit.mesh_id;
  local.triangle_id = hit.triangle_id;
  local.deformed = shape.deforms;
  local.triangle = local.deformed ? meshes_.patches[hit.mesh_id].corners(triangle) : triangle;
  local.u = hit.u;
  local.v = hit.v;
  local.corner = shape.vertices[local.triangle[0]];
  local.edge_u = shape.vertices[local.triangle[1]] - local.corner;
  local.edge_v = shape.vertices[local.triangle[2]] - local.corner;
  local.point = local.corner + local.u * local.edge_u + local.v * local.edge_v;
  local.normal = local.edge_u.cross(local.edge_v).normalized();
  if (mesh.may_stretch) {
    PosedHit posed;
    pose_facet(local, at_trace_, posed);
    local.trace_area = posed.edge_u.cross(posed.edge_v).norm();
  }
  return local;
}

LocalHit PathPreparer::hit(const Hit& hit, std::deque<std::array<Vec3, 3>>& normals) const {
  LocalHit local = this->hit(hit);
  std::array<Vec3, 3> of_corners;
  if (find_smooth_normals(local, of_corners)) local.normals = &normals.emplace_back(of_corners);
  return local;
}

LocalHit PathPreparer::edge_hit(const Hit& hit, int num_pieces) const {
  LocalHit local = this->hit(hit);
  local.edge = sharp_edge_at(edges_->of(hit.mesh_id), hit.triangle_id, local.u, local.v);
  local.num_pieces = num_pieces;
  return local;
}

bool PathPreparer::find_smooth_normals(const LocalHit& hit, std::array<Vec3, 3>& out) const {
  if (!smooth_normals_[hit.mesh_id]) return false;
  const std::vector<Vec3>& of_vertices = *smooth_normals_[hit.mesh_id];
  const Triangle& triangle = at(hit.mesh_id).shape.triangles[hit.triangle_id];
  out = {of_vertices[triangle[0]], of_vertices[triangle[1]], of_vertices[triangle[2]]};
  return is_smooth_facet(hit.normal, out);
}

LocalPaths PathPreparer::operator()(std::span<const int64_t> indices) const {
  LocalPaths block;
  size_t num_hits = 0;
  for (const int64_t index : indices) num_hits += paths_.num_bounces[index];
  block.hits.reserve(num_hits);  // paths point into it
  block.paths.reserve(indices.size());
  for (const int64_t index : indices) {
    block.paths.push_back(local_path(index, block));
    block.longest = std::max(block.longest, block.paths.back().count);
  }
  return block;
}

LocalPath PathPreparer::local_path(int64_t index, LocalPaths& block) const {
  LocalPath path;
  path.hits = block.hits.data() + block.hits.size();
  path.recorded = paths_.hits_of(index);
  path.count = paths_.num_bounces[index];
  path.is_reversed = paths_.is_reversed(index);
  path.flags = paths_.flags[index];
  path.edge = echopath::edge_hit(path.flags);
  path.num_edges = num_edge_hits(path.flags);
  if (path.edge >= 0 && path.is_reversed) path.edge = path.count - path.edge - path.num_edges;
  for (int k = 0; k < path.count; ++k) {
    const int recorded = path.is_reversed ? path.count - 1 - k : k;
    const Hit& hit = paths_.hits_of(index)[recorded];
    path.diffuse |= (paths_.diffuse[index] >> recorded & 1) << k;
    if (path.is_edge(k)) {
      block.hits.push_back(edge_hit(hit, num_edge_pieces(path.flags)));
      path.first_material = path.edge;
      path.last_material = k;
      continue;
    }
    block.hits.push_back(this->hit(hit, block.normals));
    if (is_image(hit.mesh_id, paths_.stratum[index]) && !path.is_diffuse(k)) {
      path.image |= uint64_t{1} << k;
    } else {
      if (path.first_material < 0) path.first_material = k;
      path.last_material = k;
    }
  }
  path.sliding = sliding_hits(path);
  return path;
}

}  // namespace echopath
