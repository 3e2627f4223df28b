#pragma once
// Holds what rays need to know of each mesh of a scene.
#include <vector>

#include "echopath/em/surface_response.h"
#include "echopath/trace/mirrors/mirrors.h"

namespace echopath {

class SurfaceTable {
 public:
  SurfaceTable(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, double frequency);
  const SurfaceModel& model(uint32_t mesh_id) const { return models_[mesh_id]; }
  // Returns the index of the flagged mirror that the mesh is; -1 for other meshes.
  int mirror(uint32_t mesh_id) const { return mirror_of_mesh_[mesh_id]; }
  // Returns the width in m of the unflagged smooth surface of which the mesh is a part; 0 for meshes of facets, whose extent
  // is measured where they are hit.
  double smooth_width(uint32_t mesh_id) const { return smooth_width_[mesh_id]; }
  // Returns whether any unflagged mesh is smooth: ray differentials are followed only then.
  bool has_smooth() const { return has_smooth_; }

 private:
  std::vector<SurfaceModel> models_;
  std::vector<int> mirror_of_mesh_;
  std::vector<double> smooth_width_;
  bool has_smooth_ = false;
};

}  // namespace echopath
