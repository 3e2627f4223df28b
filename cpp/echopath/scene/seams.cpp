#include "echopath/scene/seams.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "echopath/base/disjoint_sets.h"
#include "echopath/scene/edges/edge_finder.h"
#include "echopath/scene/edges/moving_groups.h"
#include "echopath/scene/scene_edges.h"

namespace echopath {
namespace {

constexpr double kTouch = 2e-6;  // of the extent of a group of meshes: boxes nearer to each other touch

// Describes a whole mesh at one place in a group of nodes that keep their places to each other. Its parts are meshes of the
// scene.
struct Placed {
  int group = 0;  // MovingGroups
  const Mesh* surface = nullptr;
  Transform place;  // in the frame of the group
  std::vector<uint32_t> meshes;
  Box box;
  std::vector<Box> contacts;
};

// Gathers the surfaces of a scene, each once where it stands, whatever is between its parts in the order of the meshes.
class PlacedSurfaces {
 public:
  explicit PlacedSurfaces(const Scene& scene) : scene_(scene), groups_(scene) {}

  void add(uint32_t mesh_id) {
    const auto [group, place] = groups_.place_of(mesh_id);
    const MeshPtr& mesh = scene_.node_of(mesh_id).mesh;
    const Mesh* surface = &mesh->surface();
    if (mesh->whole()) {
      std::vector<size_t>& there = of_parts_[{group, surface}];
      const auto is_here = [&](size_t index) { return all[index].place.matrix() == place.matrix(); };
      if (const auto found = std::ranges::find_if(there, is_here); found != there.end()) {
        all[*found].meshes.push_back(mesh_id);
        return;
      }
      there.push_back(all.size());
    }
    Placed one{group, surface, place, {mesh_id}, {}, {}};
    for (const Vec3& vertex : surface->vertices()) one.box.extend(place * vertex);
    all.push_back(std::move(one));
  }

  std::vector<Placed> all;

 private:
  const Scene& scene_;
  MovingGroups groups_;
  std::map<std::pair<int, const Mesh*>, std::vector<size_t>> of_parts_;  // by group and surface: where in `all`
};

// Sets what of each box others of the same group touch. Sweeps along x.
void find_contacts(std::vector<Placed>& all) {
  std::map<int, Box> extent;
  for (const Placed& one : all) extent[one.group].extend(one.box);
  std::vector<size_t> order(all.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto left = [&](size_t i) { return std::tuple(all[i].group, all[i].box.min().x(), i); };
  std::ranges::sort(order, {}, left);
  for (size_t i = 0; i < order.size(); ++i) {
    Placed& one = all[order[i]];
    const Vec3 margin = Vec3::Constant(kTouch * extent[one.group].diagonal().norm());
    const Box wide(one.box.min() - margin, one.box.max() + margin);
    for (size_t k = i + 1; k < order.size(); ++k) {
      Placed& other = all[order[k]];
      if (other.group != one.group || other.box.min().x() > wide.max().x()) break;
      const Box common = wide.intersection({other.box.min() - margin, other.box.max() + margin});
      if (common.isEmpty()) continue;
      one.contacts.push_back(common);
      other.contacts.push_back(common);
    }
  }
}

// Returns an edge found in the frame of the group in that of the mesh (record/posed_edge.h goes the other way).
SharpEdge in_mesh(SharpEdge edge, const Mat3& linear, const Vec3& along) {
  for (int face = 0; face < 2; ++face) {
    const Vec3 inward = linear.inverse() * edge.inward[face];
    edge.inward[face] = (inward - along.dot(inward) * along).normalized();
    edge.normal[face] = (linear.transpose() * edge.normal[face]).normalized();
  }
  return edge;
}

// Takes stretches out of a list of edges on the same side of a triangle.
std::vector<SharpEdge> without(const std::vector<SharpEdge>& edges, const std::vector<SideStretch>& stretches) {
  std::vector<SharpEdge> left = edges;
  for (const SideStretch& out : stretches) {
    std::vector<SharpEdge> next;
    for (const SharpEdge& edge : left) {
      const bool is_there = edge.triangle == out.triangle && edge.side == out.side;
      if (!is_there || out.end <= edge.begin || out.begin >= edge.end) {
        next.push_back(edge);
        continue;
      }
      constexpr double kLeast = 1e-5;  // of a side
      SharpEdge before = edge, behind = edge;
      before.end = out.begin;
      behind.begin = out.end;
      if (before.end - before.begin > kLeast) next.push_back(before);
      if (behind.end - behind.begin > kLeast) next.push_back(behind);
    }
    left = std::move(next);
  }
  return left;
}

// Tells which mesh of the scene has a triangle of a whole, and where.
class PartIndex {
 public:
  PartIndex(const Scene& scene, const Placed& placed) : only_(placed.meshes.front()) {
    for (const uint32_t id : placed.meshes) {
      const Mesh& mesh = *scene.node_of(id).mesh;
      for (uint32_t t = 0; t < mesh.whole_triangle().size(); ++t) place_[mesh.whole_triangle()[t]] = {id, t};
      is_whole_ = !mesh.whole();
    }
  }
  // Returns mesh ID and triangle; the mesh ID is UINT32_MAX where no mesh of the scene has the triangle.
  std::pair<uint32_t, uint32_t> operator()(uint32_t triangle) const {
    if (is_whole_) return {only_, triangle};
    const auto found = place_.find(triangle);
    return found == place_.end() ? std::pair(UINT32_MAX, 0u) : found->second;
  }

 private:
  uint32_t only_;
  bool is_whole_ = true;
  std::map<uint32_t, std::pair<uint32_t, uint32_t>> place_;
};

// Joins the surfaces of a group that touch each other.
class Seams {
 public:
  Seams(const Scene& scene, std::vector<Placed> touching) : scene_(scene), placed_(std::move(touching)) {
    std::vector<EdgeSurface> surfaces;
    for (const Placed& one : placed_) {
      surfaces.push_back({one.surface, one.place, one.contacts});
      parts_.emplace_back(scene, one);
    }
    found_ = find_edges(surfaces);
  }

  void apply(std::vector<std::vector<SharpEdge>>& edges, DisjointSets& bodies) const {
    std::map<uint32_t, std::vector<SideStretch>> covered;  // by mesh ID, in its triangles
    for (const Seam& seam : found_.seams) {
      uint32_t first = UINT32_MAX;
      for (SideStretch stretch : seam) {
        const auto [id, triangle] = parts_[stretch.surface](stretch.triangle);
        if (id == UINT32_MAX) continue;
        stretch.triangle = triangle;
        covered[id].push_back(stretch);
        if (first != UINT32_MAX) bodies.join(first, id);
        first = id;
      }
    }
    for (const auto& [id, stretches] : covered) edges[id] = without(scene_.node_of(id).mesh->sharp_edges(), stretches);
    for (const FoundEdge& found : found_.edges) add(found, edges);
  }

 private:
  void add(const FoundEdge& found, std::vector<std::vector<SharpEdge>>& edges) const {
    const auto [id, triangle] = parts_[found.surface](found.edge.triangle);
    if (id == UINT32_MAX) return;
    const Mesh& surface = *placed_[found.surface].surface;
    const Triangle& corners = surface.triangles()[found.edge.triangle];
    const Vec3 along =
        (surface.vertices()[corners[(found.edge.side + 1) % 3]] - surface.vertices()[corners[found.edge.side]]).normalized();
    SharpEdge edge = in_mesh(found.edge, placed_[found.surface].place.linear(), along);
    edge.triangle = triangle;
    edges[id].push_back(edge);
  }

  const Scene& scene_;
  std::vector<Placed> placed_;
  std::vector<PartIndex> parts_;
  FoundEdges found_;
};

// Returns the surfaces that touch others, group by group.
std::vector<std::vector<Placed>> touching_groups(const Scene& scene) {
  PlacedSurfaces placed(scene);
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    if (has_echoing_edges(scene, id)) placed.add(id);
  }
  std::vector<Placed>& all = placed.all;
  find_contacts(all);
  std::map<int, std::vector<Placed>> groups;
  for (Placed& one : all) {
    if (!one.contacts.empty()) groups[one.group].push_back(std::move(one));
  }
  std::vector<std::vector<Placed>> out;
  for (auto& [group, members] : groups) out.push_back(std::move(members));
  return out;
}

}  // namespace

SeamedEdges::SeamedEdges(const Scene& scene) : edges(scene.meshes().size()), is_changed(edges.size()) {
  DisjointSets bodies(edges.size());
  for (std::vector<Placed>& group : touching_groups(scene)) {
    for (const Placed& one : group) {
      for (const uint32_t id : one.meshes) {
        edges[id] = scene.node_of(id).mesh->sharp_edges();
        is_changed[id] = true;
        bodies.join(one.meshes.front(), id);
      }
    }
    Seams(scene, std::move(group)).apply(edges, bodies);
  }
  const auto key = [](const SharpEdge& edge) { return std::tie(edge.triangle, edge.side, edge.begin); };
  for (std::vector<SharpEdge>& own : edges) std::ranges::sort(own, {}, key);
  body = bodies.names();
}

}  // namespace echopath
