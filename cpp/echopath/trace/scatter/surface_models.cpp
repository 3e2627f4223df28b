#include "echopath/trace/scatter/surface_models.h"

#include <unordered_map>

namespace echopath {

SurfaceModels::SurfaceModels(const Scene& scene, double frequency) {
  std::unordered_map<const Material*, uint32_t> index;  // in models_
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Material& material = *scene.node_of(id).material;
    const auto [entry, is_new] = index.try_emplace(&material, static_cast<uint32_t>(models_.size()));
    model_of_.push_back(entry->second);
    if (!is_new) continue;
    models_.emplace_back(material, frequency);
    if (material.layers.size() > 1) backs_.emplace(entry->second, SurfaceModel(material, frequency, SheetSide::kBack));
  }
}

}  // namespace echopath
