#pragma once
// A scene is a tree of named nodes with placements, motions and meshes; a pose is its geometry at one time.
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "echopath/em/material.h"
#include "echopath/motion/deformation.h"
#include "echopath/scene/mesh/mesh.h"

namespace echopath {

using MaterialPtr = std::shared_ptr<const Material>;

// Stands in the place of a mesh ID where there is no mesh.
inline constexpr uint32_t kNoMesh = std::numeric_limits<uint32_t>::max();

struct Node {
  std::string name;                                // full path, "street/pedestrian/arm_left"
  int parent = -1;                                 // index of the parent, -1: child of the root
  Transform placement = Transform::Identity();     // at rest, relative to the parent
  std::shared_ptr<const Motion> motion;            // may be null
  MeshPtr mesh;                                    // may be null
  std::shared_ptr<const Deformation> deformation;  // may be null; its vertices replace the mesh's
  MaterialPtr material;                            // null where there is no mesh
  std::string material_name;                       // as the user gave it, may be empty
  bool smooth = false;                             // the mesh stands for a curved surface (scene/smooth/smooth.h)
  bool visible = true;                             // false: neither it nor what is below it takes part in anything
  TimeSpan lifetime;                               // when it is there, with what is below it (Scene::hide_absent)
};

// Tells where a mesh ID stands in the tree.
struct SceneMesh {
  int node = 0;    // index into Scene::nodes()
  int object = 0;  // index of the child of the root above it (or itself)
  // Counts the meshes before it, also those that do not take part: random numbers of its surface go by it, so that they stay
  // the same when another mesh is hidden.
  uint32_t number = 0;
};

// The full name of a node tells for good which one is meant. Indices of nodes and mesh IDs count without gaps what is there
// now, so that arrays by mesh ID are dense and a changed scene equals one that was built so from the start; whoever records
// them keeps a copy of the scene beside them, as Paths do. Copies share meshes, motions and materials, which cannot change.
class Scene {
 public:
  // Adds a node and returns its index. `node.name` is its own name without the parent's; it must be non-empty, unique
  // among its siblings and free of '/', '*', '?', quotes and white space at the ends. A mesh needs a material; a
  // deformation needs a mesh and as many vertices as the mesh was made from. Raises invalid_argument, and then adds
  // nothing.
  int add(Node node);
  // Gives a node everything of `node` but the name and the parent, which stay. Raises as add does, and then changes nothing.
  void change(int index, Node node);
  // Removes a node with all that is below it. The nodes behind them move up.
  void remove(int index);
  // Hides the nodes that are not there during all of a frame, from `begin` to `end` (s).
  void hide_absent(double begin, double end);
  // Takes the meshes away from all nodes but those of `kept` [mesh ID]. The nodes stay, with their motions.
  void keep_meshes(const std::vector<bool>& kept);

  const std::vector<Node>& nodes() const { return nodes_; }
  // Returns whether a node and all above it are visible. What does not take part has no mesh ID, and its motions are not
  // asked for anything.
  bool takes_part(int index) const { return takes_part_[index]; }
  // Returns when a node and all above it are there. It is empty, with its end before its begin, where they never are.
  TimeSpan lifetime(int index) const;
  bool has_lifetimes() const;                                       // whether some node is not always there
  const std::vector<SceneMesh>& meshes() const { return meshes_; }  // that take part, by mesh ID
  const Node& node_of(uint32_t mesh_id) const { return nodes_[meshes_[mesh_id].node]; }
  int64_t num_triangles() const;                // of the meshes that take part
  std::vector<std::string> mesh_names() const;  // by mesh ID
  // Returns the names by mesh ID, and behind them those of meshes that do not take part: a selection may name them too.
  std::vector<std::string> all_mesh_names() const;
  std::optional<int> find(std::string_view full_name) const;  // node index
  // Returns whether its placement and those above it turn the corners of triangles the other way round: what is the front of
  // the body, the side from which they go anticlockwise, is then the back of its surface in the world.
  bool is_mirrored(int index) const;

  // Returns parent_from_node at `time` (s). The motion of what does not take part is not asked for anything.
  Transform local_transform(int index, double time) const;
  // Returns whether a mesh moves at some time: its node or an ancestor has a motion, or it deforms, other than at rest.
  bool is_moving(uint32_t mesh_id) const;
  bool is_anything_moving() const;
  // Returns whether a mesh is the same at all times: it does not move, and is always there.
  bool stands_still(uint32_t mesh_id) const;
  // Marks the meshes that stand still [mesh ID], but for those below a node whose own mesh does not.
  std::vector<bool> still_meshes() const;
  // Marks the nodes at or below which a marked mesh [mesh ID] hangs [node].
  std::vector<bool> nodes_above(const std::vector<bool>& meshes) const;
  bool ever_changes() const { return is_anything_moving() || has_lifetimes(); }
  // Returns whether its triangles may change their areas: it deforms, or it moves and a placement above it, or its own,
  // scales unevenly.
  bool may_stretch(uint32_t mesh_id) const;
  // Returns those of all motions that take part, ascending (Motion::breakpoints).
  std::vector<double> breakpoints(const TimeSpan& during = {}) const;
  // Raises invalid_argument naming the node when a motion that takes part is not defined on all of [begin, end] (s) within
  // the lifetime of its node.
  void require_times(double begin, double end) const;

 private:
  const Node& at(int index) const { return nodes_[index]; }
  void require_node(int index) const;
  void number_node(int index);
  void number_all();

  std::vector<Node> nodes_;  // parents before their children
  std::vector<bool> takes_part_;
  std::vector<SceneMesh> meshes_;
  uint32_t num_all_meshes_ = 0;                 // also those that do not take part
  std::unordered_map<std::string, int> index_;  // full name -> node
};

// Returns whether a glob matches the full name of a mesh or of one of its ancestors; '*' crosses '/', '?' is one character.
bool glob_takes(std::string_view glob, std::string_view full_name);
// Returns the full names of all meshes and of the groups above them, sorted; these are the names that a glob can match.
std::vector<std::string> names_with_ancestors(const std::vector<std::string>& mesh_names);

// Returns the vertices [V] of one mesh in world coordinates and poses nothing else.
std::vector<Vec3> world_vertices(const Scene& scene, uint32_t mesh_id, double time);
// Returns the centroid of the surface of some meshes together, in the world, m; of none it is not a number.
Vec3 surface_centroid(const Scene& scene, std::span<const uint32_t> mesh_ids, double time);

// Returns world_from_node of each node, by index. The motions of what does not take part are not asked for anything.
std::vector<Transform> world_from_nodes(const Scene& scene, double time);

}  // namespace echopath
