#include "echopath/trace/live/record_match.h"

#include <algorithm>
#include <string>
#include <unordered_map>

namespace echopath {
namespace {

bool is_any_mirror(const Scene& scene, const ChangedMeshes& changed) {
  for (uint32_t id = 0; id < changed.size(); ++id) {
    if (changed[id] && scene.node_of(id).material->mirror) return true;
  }
  return false;
}

double surface_of(const FloatBox& box) {
  const Eigen::Vector3d sizes = box.sizes().cast<double>();
  return 2.0 * (sizes.x() * sizes.y() + sizes.y() * sizes.z() + sizes.z() * sizes.x());
}

// Adds the boxes of where a mesh was and is; where they lie together, one that holds both. A box is met by stretches about
// as often as its surface is large.
void add_boxes(const Box& was, const Box& is, std::vector<FloatBox>& boxes) {
  std::vector<FloatBox> own;
  for (const Box* box : {&was, &is}) {
    if (!box->isEmpty()) own.push_back(box->cast<float>());
  }
  if (own.size() == 2) {
    const FloatBox both = own[0].merged(own[1]);
    if (surface_of(both) < surface_of(own[0]) + surface_of(own[1])) own = {both};
  }
  boxes.insert(boxes.end(), own.begin(), own.end());
}

std::vector<FloatBox> changed_boxes(const LiveRecord& before, const LiveRecord& after, const SceneChanges& changes) {
  std::vector<FloatBox> boxes;
  const Box nowhere;
  for (size_t id = 0; id < changes.of_before.size(); ++id) {
    const uint32_t now = changes.id_after[id];
    if (changes.of_before[id]) add_boxes(before.boxes[id], now == kNoMesh ? nowhere : after.boxes[now], boxes);
  }
  for (size_t id = 0; id < changes.of_after.size(); ++id) {
    if (changes.id_before[id] == kNoMesh) add_boxes(nowhere, after.boxes[id], boxes);
  }
  return boxes;
}

void renumber(std::vector<Hit>& hits, const std::vector<uint32_t>& ids) {
  for (Hit& hit : hits) hit.mesh_id = ids[hit.mesh_id];
}

}  // namespace

RecordMatch::RecordMatch(const LiveRecord* before, const LiveRecord& after) : before_(before), after_(after) {
  if (!before || !before->shared.is_same(after.shared)) return;
  const bool time_moved = before->empty.frame.trace_time != after.empty.frame.trace_time;
  common_.meshes = changes_between(*before->empty.scene, *after.empty.scene, time_moved);
  if (!common_.meshes.has_same_order || is_any_mirror_changed()) return;
  shares_rays_ = true;
  match_strata();
  match_owners();
  boxes_ = changed_boxes(*before, after, common_.meshes);
  add_boxes_of_other_density();
}

bool RecordMatch::is_any_mirror_changed() const {
  return is_any_mirror(*before_->empty.scene, common_.meshes.of_before) ||
         is_any_mirror(*after_.empty.scene, common_.meshes.of_after);
}

void RecordMatch::match_strata() {
  const std::vector<Stratum>&was = before_->shared.strata, &is = after_.shared.strata;
  std::unordered_map<std::string, int> by_name;
  for (size_t k = 0; k < was.size(); ++k) by_name.emplace(was[k].name, static_cast<int>(k));
  stratum_after_.assign(was.size(), -1);
  for (size_t k = 0; k < is.size(); ++k) {
    const auto found = by_name.find(is[k].name);
    const int known = found == by_name.end() ? -1 : found->second;
    const bool is_alike = known >= 0 && is_launched_alike(was[known], is[k]);
    of_same_name_.push_back(known);
    common_.stratum_before.push_back(is_alike ? known : -1);
    if (is_alike) stratum_after_[known] = static_cast<int>(k);
  }
  has_same_numbers_ = common_.meshes.has_same_ids && was.size() == is.size();
  for (size_t k = 0; k < is.size(); ++k) {
    const int known = common_.stratum_before[k];
    has_same_numbers_ = has_same_numbers_ && (known < 0 || known == static_cast<int>(k));
  }
}

// Where other strata own the echoes of a mesh, it counts as changed. Where they are the same but have other rays, the
// weights of echoes at the mesh may be others, because they depend on the density of these rays: then what has hits there
// does not stay.
void RecordMatch::match_owners() {
  const RayOwners &was = before_->shared.owners, &is = after_.shared.owners;
  const auto is_same = [&](const auto& a, const auto& b) {
    return a.first == b.first && of_same_name_[b.second] == a.second;
  };
  const auto is_alike = [&](const auto& one) { return common_.stratum_before[one.second] >= 0; };
  has_other_density_.assign(common_.meshes.of_before.size(), false);
  for (uint32_t id = 0; id < common_.meshes.of_after.size(); ++id) {
    if (common_.meshes.of_after[id]) continue;
    const uint32_t known = common_.meshes.id_before[id];
    const auto before = was.strata_of(known), after = is.strata_of(id);
    if (!std::equal(before.begin(), before.end(), after.begin(), after.end(), is_same)) common_.meshes.mark(id);
    has_other_density_[known] = !std::ranges::all_of(after, is_alike);
    any_other_density_ = any_other_density_ || has_other_density_[known];
  }
}

// Shares of both orders of two bounces, of which one is over a smooth mesh, depend on the density of rays (MirrorOrders) and
// may be zero: then no path of a block shows that its rays met the mesh.
void RecordMatch::add_boxes_of_other_density() {
  const Scene& scene = *before_->empty.scene;
  bool any_smooth = false;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) any_smooth = any_smooth || scene.node_of(id).smooth;
  for (uint32_t id = 0; any_smooth && id < has_other_density_.size(); ++id) {
    if (has_other_density_[id]) boxes_.push_back(before_->boxes[id].cast<float>());
  }
}

bool RecordMatch::has_hits_of_other_density(const PathBlock& paths) const {
  if (!any_other_density_) return false;
  const auto is_one = [&](const Hit& hit) { return has_other_density_[hit.mesh_id]; };
  return std::ranges::any_of(paths.hits, is_one) ||
         std::ranges::any_of(paths.fans, [&](const PathFan& fan) { return is_one(fan.hit); });
}

// Returns the index of the block before that has the rays of one after, as far as their strata tell.
int64_t RecordMatch::known_block(size_t index) const {
  const std::vector<size_t>&was = before_->first_block, &is = after_.first_block;
  if (index >= is.back()) {
    const size_t known = was.back() + index - is.back();
    return known < before_->blocks.size() ? static_cast<int64_t>(known) : -1;
  }
  const auto stratum = static_cast<size_t>(std::ranges::upper_bound(is, index) - is.begin()) - 1;
  const int before = common_.stratum_before[stratum];
  return before < 0 ? -1 : static_cast<int64_t>(was[before] + index - is[stratum]);
}

// The points of a mesh depend on its ID.
bool RecordMatch::aims_alike(int64_t begin, int64_t end) const {
  const SharedByRays &was = before_->shared, &is = after_.shared;
  for (int64_t ray = begin; ray < end; ++ray) {
    const auto k = static_cast<size_t>(ray - is.first_point);
    if (k >= was.surface_scatterers.size() || !(was.surface_scatterers[k] == is.surface_scatterers[k])) return false;
    const SurfacePoint& point = is.surface_scatterers[k];
    if (common_.stratum_before[point.stratum] != point.stratum) return false;
    if (common_.meshes.id_before[point.on.mesh_id] != point.on.mesh_id) return false;
  }
  return true;
}

int64_t RecordMatch::kept(size_t index, int64_t begin, int64_t end) const {
  const int64_t known = shares_rays_ ? known_block(index) : -1;
  if (known < 0) return -1;
  const LiveBlock& block = *before_->blocks[known];
  if (block.num_rays != end - begin) return -1;
  if (index >= after_.first_block.back() && !aims_alike(begin, end)) return -1;
  return block.space->meets(boxes_) || has_hits_of_other_density(block.paths) ? -1 : known;
}

LiveBlockPtr RecordMatch::renumbered(const LiveBlockPtr& block) const {
  if (has_same_numbers_) return block;
  auto out = std::make_shared<LiveBlock>(*block);
  PathBlock& paths = out->paths;
  for (std::vector<Hit>* hits : {&paths.hits, &paths.fan_hits, &paths.chain_hits}) renumber(*hits, common_.meshes.id_after);
  const auto stratum_now = [&](uint16_t stratum) {
    return stratum == kNoStratum ? kNoStratum : static_cast<uint16_t>(stratum_after_[stratum]);
  };
  for (PathFan& fan : paths.fans) {
    fan.hit.mesh_id = common_.meshes.id_after[fan.hit.mesh_id];
    fan.stratum = stratum_now(fan.stratum);
  }
  for (size_t i = 0; i < paths.rows.size(); ++i) paths.rows.stratum[i] = stratum_now(paths.rows.stratum[i]);
  return out;
}

}  // namespace echopath
