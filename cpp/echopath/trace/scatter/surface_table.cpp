#include "echopath/trace/scatter/surface_table.h"

#include <unordered_map>

#include "echopath/scene/mesh/surface_widths.h"

namespace echopath {
namespace {

bool is_unflagged_smooth(const Node& node) { return node.smooth && !node.material->mirror; }

}  // namespace

SurfaceTable::SurfaceTable(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                           double frequency)
    : geometry_(geometry), mirror_of_(mirrors, geometry) {
  SurfaceWidths widths;
  std::unordered_map<const Material*, uint32_t> index;  // in models_
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    const auto [entry, is_new] = index.try_emplace(node.material.get(), static_cast<uint32_t>(models_.size()));
    if (is_new) add_model(*node.material, frequency);
    model_of_.push_back(entry->second);
    const auto measure = [&] { return widths.width_of(*node.mesh, geometry.vertices(id)); };
    smooth_width_.push_back(is_unflagged_smooth(node) ? geometry.width(id, measure) : 0.0);
    has_smooth_ = has_smooth_ || is_unflagged_smooth(node);
  }
}

void SurfaceTable::add_model(const Material& material, double frequency) {
  const auto index = static_cast<uint32_t>(models_.size());
  models_.emplace_back(material, frequency);
  if (material.layers.size() > 1) backs_.emplace(index, SurfaceModel(material, frequency, SheetSide::kBack));
  has_lobes_ = has_lobes_ || !models_.back().lobe().is_lambert();
  may_scatter_ = may_scatter_ || models_.back().may_scatter();
}

bool SurfaceTable::is_met_from_behind(const Hit& hit, const Vec3& normal) const {
  if (!backs_.contains(model_of_[hit.mesh_id])) return false;
  const auto [a, b, c] = geometry_.corners(hit.mesh_id, hit.triangle_id);
  return cross_of_sides(a, b, c).dot(normal) < 0.0;
}

}  // namespace echopath
