#include "echopath/scene/scene.h"

#include <algorithm>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/text/quoted.h"
#include "echopath/base/text/streamed.h"
#include "echopath/motion/spline.h"

namespace echopath {
namespace {

void check_name(const std::string& name) {
  require(!name.empty(), "name", "must not be empty", "''");
  require(name.find_first_of("/*?'\"") == std::string::npos, "name", "must be free of / * ? and quotes", name);
  // These characters join names into keys (label/objects/families.h, label/grouping.h).
  require(name.find_first_of("\x1e\x1f") == std::string::npos, "name", "must be free of the signs 0x1e and 0x1f",
          quoted(name));
  require(name.find('\0') == std::string::npos, "name", "must be free of the sign NUL, at which files cut it", quoted(name));
  const std::string blanks = " \t\r\n\v\f";
  const bool bare = blanks.find(name.front()) == std::string::npos && blanks.find(name.back()) == std::string::npos;
  require(bare, "name", "must not begin or end with white space", "'" + name + "'");
}

void check_content(const Node& node) {
  require(node.placement.matrix().allFinite(), "placement", "must be finite in node", node.name);
  require(node.placement.linear().determinant() != 0.0, "placement", "must not flatten space in node", node.name);
  require(!node.mesh || node.material, "material", "must be given with a mesh in node", node.name);
  require(node.mesh || !node.material, "material", "must not be given without a mesh in node", node.name);
  if (node.material) node.material->validate();
  require(node.lifetime.begin < node.lifetime.end, "lifetime", "must be a begin and an end in s, ascending, in node",
          node.name);
  require(!node.motion || node.motion->is_rigid(), "motion", "must keep lengths: scales move joints of a Skin alone; node",
          node.name);
  if (!node.deformation) return;
  require(node.mesh != nullptr, "deformation", "must not be given without a mesh in node", node.name);
  const int64_t num_input = node.mesh->num_input_vertices();
  require(node.deformation->num_vertices() == num_input, "deformation",
          "must have the " + std::to_string(num_input) + " vertices the mesh was made from",
          std::to_string(node.deformation->num_vertices()) + " in node " + node.name);
}

bool scales_unevenly(const Mat3& linear) {
  constexpr double kSlack = 1e-12;  // relative
  const Mat3 gram = linear.transpose() * linear;
  const double mean = gram.trace() / 3.0;
  return (gram - mean * Mat3::Identity()).cwiseAbs().maxCoeff() > kSlack * mean;
}

bool covers(const TimeSpan& span, double begin, double end, double slack = 0.0) {
  return begin >= span.begin - slack && end <= span.end + slack;
}

void require_span(const TimeSpan& span, double begin, double end, const std::string& name) {
  if (covers(span, begin, end, rounding_of(span.begin, span.end))) return;  // as the motions do
  const std::string times = begin < end ? streamed("from ", begin, " to ", end) : streamed("at ", begin);
  require(false, "motion", "must be defined " + times + " s (that of an actor is as long as its duration=); node " + name,
          streamed(span.begin, " to ", span.end, " s"));
}

}  // namespace

int Scene::add(Node node) {
  check_name(node.name);
  const int num_nodes = static_cast<int>(nodes_.size());
  require(node.parent >= -1 && node.parent < num_nodes, "parent", "must be -1 or the index of a node", node.parent);
  check_content(node);
  if (node.parent >= 0) node.name = at(node.parent).name + "/" + node.name;
  require(!index_.contains(node.name), "name", "must be unique among its siblings", node.name);
  index_.emplace(node.name, num_nodes);
  nodes_.push_back(std::move(node));
  number_node(num_nodes);
  return num_nodes;
}

void Scene::change(int index, Node node) {
  require_node(index);
  check_content(node);
  Node& present = nodes_[index];
  const bool same_ids = node.visible == present.visible && !node.mesh == !present.mesh;
  node.name = std::move(present.name);
  node.parent = present.parent;
  present = std::move(node);
  if (!same_ids) number_all();
}

void Scene::remove(int index) {
  require_node(index);
  std::vector<int> place(nodes_.size(), -1);  // among those that stay
  std::vector<Node> kept;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    const int parent = node.parent < 0 ? -1 : place[node.parent];
    if (static_cast<int>(i) == index || (node.parent >= 0 && parent < 0)) continue;
    place[i] = static_cast<int>(kept.size());
    node.parent = parent;
    kept.push_back(std::move(node));
  }
  nodes_ = std::move(kept);
  index_.clear();
  for (size_t i = 0; i < nodes_.size(); ++i) index_.emplace(nodes_[i].name, static_cast<int>(i));
  number_all();
}

void Scene::hide_absent(double begin, double end) {
  for (Node& node : nodes_) node.visible = node.visible && covers(node.lifetime, begin, end, rounding_of(begin, end));
  number_all();
}

void Scene::keep_meshes(const std::vector<bool>& kept) {
  std::vector<bool> keeps(nodes_.size());
  for (size_t id = 0; id < meshes_.size(); ++id) keeps[meshes_[id].node] = kept[id];
  for (size_t i = 0; i < nodes_.size(); ++i) {
    if (keeps[i]) continue;
    nodes_[i].mesh = nullptr;
    nodes_[i].deformation = nullptr;
    nodes_[i].material = nullptr;
  }
  number_all();
}

void Scene::require_node(int index) const {
  require(index >= 0 && index < static_cast<int>(nodes_.size()), "index", "must be that of a node", index);
}

// Parents come before their children, so it is known of the parent whether it takes part.
void Scene::number_node(int index) {
  const Node& node = at(index);
  takes_part_.push_back(node.visible && (node.parent < 0 || takes_part(node.parent)));
  if (!node.mesh) return;
  SceneMesh mesh{index, index, num_all_meshes_++};
  if (!takes_part(index)) return;
  for (int above = node.parent; above >= 0; above = at(above).parent) mesh.object = above;
  meshes_.push_back(mesh);
}

void Scene::number_all() {
  takes_part_.clear();
  meshes_.clear();
  num_all_meshes_ = 0;
  for (int index = 0; index < static_cast<int>(nodes_.size()); ++index) number_node(index);
}

TimeSpan Scene::lifetime(int index) const {
  TimeSpan common;
  for (int i = index; i >= 0; i = at(i).parent) {
    common.begin = std::max(common.begin, at(i).lifetime.begin);
    common.end = std::min(common.end, at(i).lifetime.end);
  }
  return common;
}

bool Scene::has_lifetimes() const {
  const TimeSpan always;
  return !std::ranges::all_of(nodes_, [&](const Node& node) { return covers(node.lifetime, always.begin, always.end); });
}

int64_t Scene::num_triangles() const {
  int64_t total = 0;
  for (const SceneMesh& mesh : meshes_) total += static_cast<int64_t>(at(mesh.node).mesh->triangles().size());
  return total;
}

std::vector<std::string> Scene::mesh_names() const {
  std::vector<std::string> names;
  names.reserve(meshes_.size());
  for (const SceneMesh& mesh : meshes_) names.push_back(at(mesh.node).name);
  return names;
}

std::vector<std::string> Scene::all_mesh_names() const {
  std::vector<std::string> names = mesh_names();
  for (int index = 0; index < static_cast<int>(nodes_.size()); ++index) {
    if (at(index).mesh && !takes_part(index)) names.push_back(at(index).name);
  }
  return names;
}

std::optional<int> Scene::find(std::string_view full_name) const {
  const auto found = index_.find(std::string(full_name));
  return found == index_.end() ? std::nullopt : std::optional<int>(found->second);
}

bool Scene::is_mirrored(int index) const {
  bool mirrored = false;
  for (int i = index; i >= 0; i = nodes_[i].parent) mirrored ^= nodes_[i].placement.linear().determinant() < 0;
  return mirrored;
}

bool Scene::is_moving(uint32_t mesh_id) const {
  if (moves(node_of(mesh_id).deformation)) return true;
  for (int i = meshes_[mesh_id].node; i >= 0; i = at(i).parent) {
    if (moves(at(i).motion)) return true;
  }
  return false;
}

bool Scene::stands_still(uint32_t mesh_id) const {
  const TimeSpan always;
  return !is_moving(mesh_id) && covers(lifetime(meshes_[mesh_id].node), always.begin, always.end);
}

std::vector<bool> Scene::still_meshes() const {
  std::vector<bool> changes(nodes_.size(), false);  // the own mesh of a node
  for (uint32_t id = 0; id < meshes_.size(); ++id) changes[meshes_[id].node] = !stands_still(id);
  std::vector<bool> still;
  for (const SceneMesh& mesh : meshes_) {
    int node = mesh.node;
    while (node >= 0 && !changes[node]) node = at(node).parent;
    still.push_back(node < 0);
  }
  return still;
}

std::vector<bool> Scene::nodes_above(const std::vector<bool>& meshes) const {
  std::vector<bool> above(nodes_.size(), false);
  for (uint32_t id = 0; id < meshes.size(); ++id) {
    if (!meshes[id]) continue;
    for (int node = meshes_[id].node; node >= 0 && !above[node]; node = at(node).parent) above[node] = true;
  }
  return above;
}

bool Scene::is_anything_moving() const {
  for (uint32_t mesh_id = 0; mesh_id < meshes().size(); ++mesh_id) {
    if (is_moving(mesh_id)) return true;
  }
  return false;
}

bool Scene::may_stretch(uint32_t mesh_id) const {
  if (moves(node_of(mesh_id).deformation)) return true;
  if (!is_moving(mesh_id)) return false;
  for (int i = meshes_[mesh_id].node; i >= 0; i = at(i).parent) {
    if (scales_unevenly(at(i).placement.linear())) return true;
  }
  return false;
}

std::vector<double> Scene::breakpoints(const TimeSpan& during) const {
  std::vector<double> all;
  const auto append = [&](const std::vector<double>& times) { all.insert(all.end(), times.begin(), times.end()); };
  for (int index = 0; index < static_cast<int>(nodes_.size()); ++index) {
    const Node& node = at(index);
    if (!takes_part(index)) continue;
    if (node.motion) append(node.motion->breakpoints(during));
    if (node.deformation) append(node.deformation->breakpoints(during));
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void Scene::require_times(double begin, double end) const {
  for (int index = 0; index < static_cast<int>(nodes_.size()); ++index) {
    const Node& node = at(index);
    if (!takes_part(index) || (!node.motion && !node.deformation)) continue;
    const TimeSpan there = lifetime(index);
    const double from = std::max(begin, there.begin), until = std::min(end, there.end);
    if (from > until) continue;
    if (node.motion) require_span(node.motion->span(), from, until, node.name);
    if (node.deformation) require_span(node.deformation->span(), from, until, node.name);
  }
}

}  // namespace echopath
