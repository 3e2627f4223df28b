#include "echopath/label/objects/surfaces.h"

#include <algorithm>
#include <limits>
#include <set>

#include "echopath/base/errors.h"
#include "echopath/base/principal_box.h"
#include "echopath/base/text/nearest_names.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/scene/large_planes.h"
#include "echopath/trace/strata/scene_objects.h"

namespace echopath {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr double kSureOutside = 1.001;
constexpr double kFlat = 0.1;    // of its middle side: the smallest side of a wall or a road, at most
constexpr double kBeside = 0.5;  // m; a body as near to the antenna is what the radar is mounted on,
constexpr double kAhead = 0.05;  // m; but for one that begins farther before it

// Fills in the surfaces of meshes that belong to no object.
class SurfaceFinder {
 public:
  SurfaceFinder(const Scene& scene, SurfaceMap& map)
      : scene_(scene), map_(map), holds_object_(scene.nodes().size()), num_mirrors_(scene.nodes().size()),
        surface_of_(scene.nodes().size(), kNone) {
    for (uint32_t mesh = 0; mesh < map.of_mesh.size(); ++mesh) count(mesh);
  }
  void run() {
    for (uint32_t mesh = 0; mesh < map_.of_mesh.size(); ++mesh) {
      if (map_.of_mesh[mesh] == kNone) map_.of_mesh[mesh] = surface_at(highest_group(scene_.meshes()[mesh].node));
    }
  }

 private:
  int parent_of(int node) const { return scene_.nodes()[node].parent; }

  void count(uint32_t mesh) {
    const bool in_object = map_.of_mesh[mesh] != kNone;
    const bool is_mirror = scene_.node_of(mesh).material->mirror;
    for (int node = scene_.meshes()[mesh].node; node >= 0; node = parent_of(node)) {
      if (in_object) holds_object_[node] = true;
      else if (is_mirror) ++num_mirrors_[node];
    }
  }

  int highest_group(int node) const {
    const auto is_one_surface = [&](int above) { return !holds_object_[above] && num_mirrors_[above] < 2; };
    for (int above = parent_of(node); above >= 0 && is_one_surface(above); above = parent_of(above)) node = above;
    return node;
  }

  uint32_t surface_at(int node) {
    uint32_t& surface = surface_of_[node];
    if (surface == kNone) {
      surface = static_cast<uint32_t>(map_.names.size());
      map_.names.push_back(scene_.nodes()[node].name);
    }
    return surface;
  }

  const Scene& scene_;
  SurfaceMap& map_;
  std::vector<bool> holds_object_;    // by node
  std::vector<int> num_mirrors_;      // by node
  std::vector<uint32_t> surface_of_;  // by node
};

void require_takes_mesh(bool takes_any, const std::string& glob, const std::vector<std::string>& mesh_names) {
  if (takes_any) return;
  std::string nearest;
  for (const std::string& name : nearest_names(glob, names_with_ancestors(mesh_names))) {
    nearest += (nearest.empty() ? "" : ", ") + name;
  }
  require(false, "objects", "must be globs that take meshes (nearest names: " + nearest + ")", "'" + glob + "'");
}

// Gives the meshes that `glob` takes to `object` unless another object has them. Returns whether it takes one that does not
// take part; their names stand behind those of the others.
bool take_meshes(const std::string& glob, uint32_t object, const std::vector<std::string>& mesh_names, SurfaceMap& map) {
  bool takes_any = false, takes_hidden = false;
  for (size_t mesh = 0; mesh < mesh_names.size(); ++mesh) {
    if (!glob_takes(glob, mesh_names[mesh])) continue;
    takes_any = true;
    if (mesh >= map.of_mesh.size()) takes_hidden = true;
    else if (map.of_mesh[mesh] == kNone) map.of_mesh[mesh] = object;
  }
  require_takes_mesh(takes_any, glob, mesh_names);
  return takes_hidden;
}

// Returns a box that holds a mesh, a little larger than needed: that of the corners of its box in its own frame.
Box box_around(const Scene& scene, const PosedScene& pose, uint32_t mesh) {
  const Node& node = scene.node_of(mesh);
  const Box local = node.deformation ? box_about(pose.local_vertices(mesh)) : node.mesh->box();
  Box world;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = local.corner(static_cast<Box::CornerType>(i));
    world.extend(pose.linear(mesh) * corner + pose.world_translation(mesh));
  }
  return world;
}

// Holds from where a radar sees a scene: the place of its antenna (world), and where it looks, zero for all around.
struct Standpoint {
  Vec3 antenna, ahead;
};

bool is_all_ahead(const std::vector<Vec3>& vertices, const Standpoint& from) {
  return std::ranges::all_of(vertices, [&](const Vec3& vertex) { return (vertex - from.antenna).dot(from.ahead) > kAhead; });
}

// Returns whether what has these vertices is flat, or holds the antenna in the box along its own axes or close to it.
bool is_flat_or_holds(const std::vector<Vec3>& vertices, const Standpoint& from) {
  const PrincipalBox own = principal_box(vertices);
  Vec3 sides = own.box.sizes();
  std::ranges::sort(sides);
  if (sides[0] <= kFlat * sides[1]) return true;
  return own.box.exteriorDistance(own.coordinates(from.antenna)) <= kBeside && !is_all_ahead(vertices, from);
}

// Returns whether an object surrounds the antenna: it is all around, as a room or a vehicle is, or a wide surface beside
// it, as a wall or a road is. Its bounding sphere holds the antenna then. The radius of that sphere is no more than half a
// diagonal of any box that holds the object, and its centre lies in that box.
bool surrounds(const Scene& scene, const PosedScene& pose, const SceneObject& object, const Standpoint& from) {
  Box box;
  for (const uint32_t mesh : object.mesh_ids) box.extend(box_around(scene, pose, mesh));
  if (box.exteriorDistance(from.antenna) > kSureOutside * 0.5 * box.diagonal().norm()) return false;
  std::vector<Vec3> vertices;
  for (const uint32_t mesh : object.mesh_ids) {
    const std::vector<Vec3> more = pose.world_vertices(mesh);
    vertices.insert(vertices.end(), more.begin(), more.end());
  }
  const VerticesOf all = [&](uint32_t) -> const std::vector<Vec3>& { return vertices; };
  return bounding_sphere(all, {0}).holds(from.antenna) && is_flat_or_holds(vertices, from);
}

// Returns the objects but for what was cut from flagged mirrors: by itself it would be an object of the mirror's name.
std::vector<SceneObject> objects_beside_mirrors(const Scene& scene) {
  std::vector<SceneObject> objects = objects_of(scene);
  for (SceneObject& object : objects)
    std::erase_if(object.mesh_ids, [&](uint32_t mesh) { return is_cut_from_mirror(scene, mesh); });
  std::erase_if(objects, [](const SceneObject& object) { return object.mesh_ids.empty(); });
  return objects;
}

// Returns the nodes of the objects that surround the antenna at `time` (s). What is not there then surrounds nothing.
std::set<int> nodes_around(const Scene& scene, double time, const Standpoint& from) {
  if (scene.has_lifetimes()) {
    Scene then = scene;
    then.hide_absent(time, time);
    if (then.meshes().size() < scene.meshes().size()) return nodes_around(then, time, from);
  }
  const PosedScene pose(scene, time);
  std::set<int> around;
  for (const SceneObject& object : objects_beside_mirrors(scene)) {
    if (surrounds(scene, pose, object, from)) around.insert(object.node);
  }
  return around;
}

}  // namespace

std::vector<uint32_t> SurfaceMap::meshes_of(uint32_t surface) const {
  std::vector<uint32_t> meshes;
  for (uint32_t mesh = 0; mesh < of_mesh.size(); ++mesh) {
    if (of_mesh[mesh] == surface) meshes.push_back(mesh);
  }
  return meshes;
}

SurfaceMap map_surfaces(const Scene& scene, const std::vector<NamedGlobs>& objects) {
  const std::vector<std::string> mesh_names = scene.all_mesh_names();
  SurfaceMap map;
  map.of_mesh.assign(scene.meshes().size(), kNone);
  std::set<std::string> names;
  for (const NamedGlobs& object : objects) {
    require(!object.name.empty(), "objects", "must have non-empty names", "an empty one");
    require(names.insert(object.name).second, "objects", "must have names that differ", object.name + " twice");
    bool is_hidden = false;
    for (const std::string& glob : object.globs) is_hidden |= take_meshes(glob, map.num_objects, mesh_names, map);
    const bool has_mesh = std::ranges::find(map.of_mesh, map.num_objects) != map.of_mesh.end();
    if (is_hidden && !has_mesh) continue;
    require(has_mesh, "objects", "must each have a mesh that none before it takes", object.name);
    map.names.push_back(object.name);
    ++map.num_objects;
  }
  SurfaceFinder(scene, map).run();
  return map;
}

SurfaceMap map_surfaces(const Scene& scene, double time, const Vec3& antenna, const Vec3& ahead) {
  SurfaceMap map;
  map.of_mesh.assign(scene.meshes().size(), kNone);
  const std::set<int> around = nodes_around(scene, time, {antenna, ahead});
  for (const SceneObject& object : objects_beside_mirrors(scene)) {
    if (around.contains(object.node)) continue;
    for (const uint32_t mesh : object.mesh_ids) map.of_mesh[mesh] = map.num_objects;
    map.names.push_back(scene.nodes()[object.node].name);
    ++map.num_objects;
  }
  SurfaceFinder(scene, map).run();
  return map;
}

SurfaceMap map_surfaces(const Scene& scene, double time, const Radar& radar) {
  constexpr double kAllAround = 1e-6;  // length of a sum of boresights without a direction
  const Transform world_from_radar = radar.world_from_radar(time);
  const Vec3 sum = world_from_radar.linear() * sum_of_boresights(radar.transmitters);
  const Vec3 ahead = sum.norm() > kAllAround ? Vec3(sum.normalized()) : Vec3(Vec3::Zero());
  return map_surfaces(scene, time, mean_position(radar.transmitters, world_from_radar), ahead);
}

SurfaceMap map_surfaces(const Paths& paths) {
  return map_surfaces(*paths.scene, paths.frame.objects_time.value_or(paths.frame.trace_time), paths.radar);
}

}  // namespace echopath
