#pragma once
// Decides which meshes have trees of their own, and renews the trees of what has changed.
#include <cstdint>
#include <map>
#include <vector>

#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/embree/mesh_clusters.h"

namespace echopath {

class EmbreeScene::Trees {
 public:
  struct Scope {
    EmbreeMeshes::Extent extent;  // of the meshes
    bool is_edited = false;       // any mesh may change (Upkeep::kEdits)
  };
  // Brings the trees to the meshes, of which `changed` differ from those of the last call. Raises DeviceError and Cancelled;
  // after that it may only be destroyed.
  void update(const EmbreeMeshes& meshes, const Scope& scope, const std::vector<uint32_t>& changed, Device& device,
              Job* job);
  // Returns, by the ID of Embree's geometry, the names of the triangles of a cluster in the order in which Embree counts
  // them; null where the geometry is a mesh. It is empty where there are no clusters.
  const std::vector<const TriangleName*>& names() const { return names_; }

 private:
  struct Cluster {
    std::vector<uint32_t> mesh_ids;  // ascending: the first of them names the geometry
    std::vector<TriangleName> names;
  };
  std::vector<uint32_t> sort_out(const EmbreeMeshes& meshes, const std::vector<uint32_t>& changed);
  std::vector<uint32_t> geometries_of(const std::vector<uint32_t>& changed,
                                      const std::vector<uint32_t>& owners_before) const;
  void renew(uint32_t id, const EmbreeMeshes& meshes, Device& device);

  std::vector<uint8_t> is_small_;  // by mesh ID, as the next one: whether a cluster may hold it
  std::vector<uint32_t> owners_;   // the geometry that it is in
  std::map<uint32_t, Cluster> clusters_;
  std::vector<const TriangleName*> names_;
};

}  // namespace echopath
