#pragma once
// Holds what rays need to know of each mesh of a scene.
#include <vector>

#include "echopath/trace/mirrors/mirrors.h"
#include "echopath/trace/scatter/surface_models.h"

namespace echopath {

class SurfaceTable {
 public:
  SurfaceTable(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, double frequency);
  const SurfaceModel& model(uint32_t mesh_id) const { return models_.front(mesh_id); }
  // Returns the model for a wave that meets the surface from the side of `normal`.
  const SurfaceModel& model(const Hit& hit, const Vec3& normal) const {
    return models_.from(hit.mesh_id, [&] { return is_met_from_behind(hit, normal); });
  }
  bool is_mirror(uint32_t mesh_id) const { return mirror_of_.is_mirror(mesh_id); }
  // Returns the index of the flagged mirror on which a hit lies; -1 on other meshes.
  int mirror(const Hit& hit) const { return mirror_of_(hit.mesh_id, hit.triangle_id); }
  // Gives a hit at a point (m) of flagged mirrors that lie on each other to the one that a wave from `from` meets
  // (coplanar_mirrors.h): which of them a ray reports is chance.
  void choose_front_mirror(const Vec3& from, const Vec3& point, Hit& hit) const {
    if (has_coplanar_) choose_among_mirrors(from, point, hit);
  }
  // Returns whether any flagged mirrors lie on each other.
  bool has_coplanar() const { return has_coplanar_; }
  // Returns the width in m of the unflagged smooth surface of which the mesh is a part; 0 for meshes of facets, whose extent
  // is measured where they are hit.
  double smooth_width(uint32_t mesh_id) const { return smooth_width_[mesh_id]; }
  // Returns whether any unflagged mesh is smooth: ray differentials are followed only then.
  bool has_smooth() const { return has_smooth_; }
  // Returns whether any mesh scatters diffusely: rays take random directions and phases only then.
  bool may_scatter() const { return may_scatter_; }
  // Returns whether any mesh has another lobe than Lambert's.
  bool has_lobes() const { return has_lobes_; }

 private:
  bool is_met_from_behind(const Hit& hit, const Vec3& normal) const;
  void choose_among_mirrors(const Vec3& from, const Vec3& point, Hit& hit) const;

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  SurfaceModels models_;
  MirrorIndex mirror_of_;
  bool has_coplanar_;
  std::vector<double> smooth_width_;
  bool has_smooth_ = false, has_lobes_ = false, may_scatter_ = false;
};

}  // namespace echopath
