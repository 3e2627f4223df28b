#include "echopath/trace/scatter/surface_models.h"

#include <utility>

namespace echopath {

SurfaceModels::SurfaceModels(const Scene& scene, double frequency) {
  std::map<std::pair<const Material*, bool>, uint32_t> index;  // in models_
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Material& material = *scene.node_of(id).material;
    const bool has_sides = material.layers.size() > 1;
    const bool is_mirrored = has_sides && scene.is_mirrored(scene.meshes()[id].node);
    const auto [entry, is_new] = index.try_emplace({&material, is_mirrored}, static_cast<uint32_t>(models_.size()));
    model_of_.push_back(entry->second);
    if (!is_new) continue;
    models_.emplace_back(material, frequency, is_mirrored ? SheetSide::kBack : SheetSide::kFront);
    if (!has_sides) continue;
    backs_.emplace(entry->second, SurfaceModel(material, frequency, is_mirrored ? SheetSide::kFront : SheetSide::kBack));
  }
}

}  // namespace echopath
