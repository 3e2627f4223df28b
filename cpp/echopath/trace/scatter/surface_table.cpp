#include "echopath/trace/scatter/surface_table.h"

#include <algorithm>
#include <unordered_map>

#include "echopath/base/principal_box.h"

namespace echopath {
namespace {

// Returns the middle one of the extents along the principal axes of the vertices: the width of a plate, the diameter of a
// sphere.
double middle_extent(const std::vector<Vec3>& vertices) {
  Vec3 extents = principal_box(vertices).box.sizes();
  std::ranges::sort(extents);
  return extents[1];
}

bool is_unflagged_smooth(const Node& node) { return node.smooth && !node.material->mirror; }

// Finds how wide smooth surfaces are.
class SmoothWidths {
 public:
  double width_of(const Mesh& mesh, const std::vector<Vec3>& vertices) {
    const double width = middle_extent(vertices);
    if (!mesh.whole()) return width;
    // The whole surface is scaled as this part of it is.
    const double at_rest = middle_extent(mesh.vertices());
    return at_rest > 0 ? extent_of_whole(*mesh.whole()) * (width / at_rest) : width;
  }

 private:
  double extent_of_whole(const Mesh& whole) {
    const auto [entry, is_new] = extents_.try_emplace(&whole);
    if (is_new) entry->second = middle_extent(whole.vertices());
    return entry->second;
  }

  std::unordered_map<const Mesh*, double> extents_;  // parts share their whole
};

}  // namespace

SurfaceTable::SurfaceTable(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                           double frequency)
    : geometry_(geometry), mirror_of_(mirrors, geometry) {
  SmoothWidths widths;
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
