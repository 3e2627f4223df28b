#pragma once
// Shows one object of a scene from one point: where it would be met if it were alone, and what is nearer there.
#include <array>
#include <vector>

#include "echopath/label/objects/surfaces.h"
#include "echopath/record/stratum.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

class ObjectView {
 public:
  static constexpr uint32_t kNothing = kNoMesh;
  // Surfaces this near behind each other, relative to the distance, are one: a label on a box does not hide it.
  static constexpr double kSameDepth = 1e-5;
  static constexpr double kAfter = 1.0 + 1e-7;  // times a distance: one step of single precision
  struct Seen {
    std::array<uint32_t, kPacketSize> surface;  // the object where nothing hides it, else what does; kNothing: not there
    std::array<uint32_t, kPacketSize> mesh, hiding;  // meshes of the object and of what hides it, or kNothing
    LaneValues distance;                             // m, to the object
  };

  // The geometry and the surfaces must outlive it. `apex` (m) is relative to the geometry's origin.
  ObjectView(const EmbreeScene& geometry, const SurfaceMap& surfaces, uint32_t object, const Vec3& apex);

  const std::vector<uint32_t>& mesh_ids() const { return mesh_ids_; }
  const Vec3& apex() const { return apex_; }
  double extent() const;  // m, no less than between any two of its points
  // Returns a stratum that holds the object, or all directions where it surrounds the apex: by the boxes of its meshes, or
  // `closely` by their vertices.
  Stratum stratum(bool closely) const;
  void look(const LaneVectors& directions, int count, Seen& seen) const;
  // Writes what is nearest on the way from another point (m, relative to the geometry's origin) to those of the object that
  // `seen` tells of: the object where nothing else is, kNothing where it was not seen.
  void look_from(const Vec3& from, const LaneVectors& directions, const Seen& seen, int count, uint32_t* surface) const;

 private:
  EmbreeScene::Stretches stretches_in_boxes(const LaneVectors& directions, int count) const;
  void find_object(const LaneVectors& directions, EmbreeScene::Stretches stretches, Seen& seen) const;
  bool is_own(uint32_t mesh) const { return surfaces_.of_mesh[mesh] == object_; }

  const EmbreeScene& geometry_;
  const SurfaceMap& surfaces_;
  uint32_t object_;
  Vec3 apex_;
  std::vector<uint32_t> mesh_ids_;
  std::vector<Box> boxes_;  // of its meshes, or one of all
  uint32_t mask_ = 0;
};

}  // namespace echopath
