#include "echopath/trace/scatter/surface_table.h"

#include <algorithm>

#include "echopath/scene/mesh/surface_widths.h"
#include "echopath/trace/mirrors/coplanar_mirrors.h"

namespace echopath {
namespace {

bool is_unflagged_smooth(const Node& node) { return node.smooth && !node.material->mirror; }

}  // namespace

SurfaceTable::SurfaceTable(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                           double frequency)
    : geometry_(geometry), mirrors_(mirrors), models_(scene, frequency), mirror_of_(mirrors, geometry),
      has_coplanar_(std::ranges::any_of(mirrors, [](const Mirror& mirror) { return mirror.coplanar != nullptr; })) {
  SurfaceWidths widths;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    const auto measure = [&] { return widths.width_of(*node.mesh, geometry.vertices(id)); };
    smooth_width_.push_back(is_unflagged_smooth(node) ? geometry.width(id, measure) : 0.0);
    has_smooth_ = has_smooth_ || is_unflagged_smooth(node);
  }
  for (const SurfaceModel& model : models_.of_materials()) {
    has_lobes_ = has_lobes_ || !model.lobe().is_lambert();
    may_scatter_ = may_scatter_ || model.may_scatter();
  }
}

bool SurfaceTable::is_met_from_behind(const Hit& hit, const Vec3& normal) const {
  const auto [a, b, c] = geometry_.corners(hit.mesh_id, hit.triangle_id);
  return cross_of_sides(a, b, c).dot(normal) < 0.0;
}

void SurfaceTable::choose_among_mirrors(const Vec3& from, const Vec3& point, Hit& hit) const {
  const int index = mirror(hit);
  if (index < 0) return;
  if (const std::optional<Hit> front = hit_in_front(mirrors_, index, from, point)) hit = *front;
}

}  // namespace echopath
