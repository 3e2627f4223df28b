#pragma once
// Holds models of the surfaces of a scene at one frequency.
#include <map>
#include <vector>

#include "echopath/em/surface/surface_response.h"
#include "echopath/scene/scene.h"

namespace echopath {

class SurfaceModels {
 public:
  // frequency: Hz. The scene must outlive it.
  SurfaceModels(const Scene& scene, double frequency);
  const SurfaceModel& front(uint32_t mesh_id) const { return models_[model_of_[mesh_id]]; }
  // Returns the model for a wave that meets the surface from behind. `is_behind()` is asked only where that matters.
  template <class IsBehind>
  const SurfaceModel& from(uint32_t mesh_id, const IsBehind& is_behind) const {
    const auto back = backs_.empty() ? backs_.end() : backs_.find(model_of_[mesh_id]);
    return back == backs_.end() || !is_behind() ? front(mesh_id) : back->second;
  }
  const std::vector<SurfaceModel>& of_materials() const { return models_; }

 private:
  std::vector<SurfaceModel> models_;        // one for all meshes of a material that are mirrored, and one for all others
  std::vector<uint32_t> model_of_;          // [mesh ID]
  std::map<uint32_t, SurfaceModel> backs_;  // of sheets of several layers, by their model
};

}  // namespace echopath
