#pragma once
// Decides which meshes have trees of their own, and renews the trees of what has changed.
#include <cstdint>
#include <map>
#include <vector>

#include "echopath/trace/embree/embree_scene.h"
#include "echopath/trace/embree/mesh_clusters.h"

namespace echopath {

// Where Embree's answers come from a cluster of meshes, this tells which of them is meant, and which of its triangles.
struct TrianglePlace {
  uint32_t mesh_id, triangle_id;
};

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
  // Returns the places of the triangles of a cluster by the ID of Embree's geometry, null where that is a mesh; empty where
  // there are no clusters.
  const std::vector<const TrianglePlace*>& places() const { return places_; }

 private:
  struct Cluster {
    std::vector<uint32_t> mesh_ids;  // ascending: the first of them names the geometry
    std::vector<TrianglePlace> places;
  };
  std::vector<uint32_t> sort_out(const EmbreeMeshes& meshes, const std::vector<uint32_t>& changed);
  std::vector<uint32_t> geometries_of(const std::vector<uint32_t>& changed,
                                      const std::vector<uint32_t>& owners_before) const;
  void renew(uint32_t id, const EmbreeMeshes& meshes, Device& device);

  std::vector<uint8_t> is_small_;  // by mesh ID, as the next one: whether a cluster may hold it
  std::vector<uint32_t> owners_;   // the geometry that it is in
  std::map<uint32_t, Cluster> clusters_;
  std::vector<const TrianglePlace*> places_;
};

}  // namespace echopath
