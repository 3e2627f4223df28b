#pragma once
// Says which stratum counts the echoes of a surface.
#include <utility>
#include <vector>

#include "echopath/trace/frusta/mirror_frusta.h"

namespace echopath {

// Every first hit on a surface, straight from the transmitter or over flagged mirrors, belongs to one stratum: the one that
// aims at its object (or at that image of it) and holds all of it, else the field of view. Rays of other strata that come
// there end. The echo of an object thus comes from one lattice, or from several that share each direction (launch_focus.h),
// as if the object were alone; weights that combine kinds of rays take the density of the owner. Diffuse hits on flagged
// mirrors belong to the field of view.
class RayOwners {
 public:
  // `object_of_mesh` [meshes] is -1 for meshes at which nothing aims.
  RayOwners(std::vector<int> object_of_mesh, int num_objects, int field_of_view)
      : object_of_mesh_(std::move(object_of_mesh)), direct_(static_cast<size_t>(num_objects), field_of_view),
        over_mirrors_(static_cast<size_t>(num_objects)), field_of_view_(field_of_view) {}
  RayOwners() = default;

  void assign(int object, MirrorSequence sequence, int stratum);
  // Returns the owner of first hits on a mesh over a sequence of mirrors; negative sequences belong to the field of view.
  int owner(uint32_t mesh_id, MirrorSequence sequence) const {
    const int object = object_of_mesh_.empty() ? -1 : object_of_mesh_[mesh_id];
    if (object < 0) return field_of_view_;
    return sequence == kNoMirrors ? direct_[object] : owner_over_mirrors(static_cast<size_t>(object), sequence);
  }
  int field_of_view() const { return field_of_view_; }
  // Returns the stratum of first hits on a mesh, straight from the transmitter and over each sequence of mirrors that has
  // one of its own; it is empty where nothing aims at the mesh.
  std::vector<std::pair<MirrorSequence, int>> strata_of(uint32_t mesh_id) const;
  bool operator==(const RayOwners&) const = default;

 private:
  int owner_over_mirrors(size_t object, MirrorSequence sequence) const;

  std::vector<int> object_of_mesh_, direct_;
  std::vector<std::vector<std::pair<MirrorSequence, int>>> over_mirrors_;  // by object, sorted
  int field_of_view_ = 0;
};

}  // namespace echopath
