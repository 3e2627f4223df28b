#pragma once
// Holds what Embree reads: the vertices of all meshes at one time, relative to an origin. An update to another time computes
// only those anew that differ.
#include <memory>
#include <string>
#include <vector>

#include "echopath/posed/posed_scene.h"

namespace echopath {

class EmbreeMeshes {
 public:
  // Returns the IDs of the meshes that differ from those of the last call, ascending: all meshes where the origin (m, world)
  // or the number of meshes has changed, none where nothing moves. Raises invalid_argument naming the mesh that is out of
  // the range of coordinates (base/range_of_coordinates.h) about the origin; after that it may only be destroyed.
  std::vector<uint32_t> update(const Scene& scene, const PosedScene& pose, const Vec3& origin);

  // Returns whether an update with the same origin would find that no mesh differs.
  bool is_current(const Scene& scene, const PosedScene& pose) const;

  const Vec3& origin() const { return origin_; }  // m, world
  uint32_t size() const { return static_cast<uint32_t>(meshes_.size()); }
  const std::vector<Triangle>& triangles(uint32_t mesh_id) const { return meshes_[mesh_id].source.mesh->triangles(); }
  const std::vector<Vec3>& vertices(uint32_t mesh_id) const { return meshes_[mesh_id].vertices; }  // m
  // Returns the unit normals of the vertices; they are empty where the mesh is not smooth.
  const std::vector<Vec3>& normals(uint32_t mesh_id) const { return meshes_[mesh_id].normals; }
  const Eigen::AlignedBox3d& box(uint32_t mesh_id) const { return meshes_[mesh_id].box; }  // m
  double largest_coordinate() const;                                                       // m, of all vertices by magnitude
  int object(uint32_t mesh_id) const { return meshes_[mesh_id].source.object; }            // SceneMesh::object
  Eigen::AlignedBox3d box() const;                                                         // m, of all meshes
  // Returns the mean number of bounding boxes of meshes in which a point of the scene's bounding box lies.
  double mean_cover() const;

 private:
  // Names all that the vertices follow from: equal sources have equal vertices.
  struct Source {
    MeshPtr mesh;
    std::shared_ptr<const Deformation> deformation;
    double time = 0.0;                // s, where it deforms
    Mat3 linear = Mat3::Identity();   // of the pose
    Vec3 translation = Vec3::Zero();  // m, world
    bool smooth = false;
    int object = -1;  // SceneMesh::object
    bool is_same(const Source& other) const;
  };
  struct Posed {
    Source source;
    std::vector<Vec3> vertices, normals;
    Eigen::AlignedBox3d box;
  };
  static Source source_of(const Scene& scene, const PosedScene& pose, uint32_t mesh_id);
  void place(Posed& posed, const PosedScene& pose, uint32_t mesh_id, const std::string& name) const;

  Vec3 origin_ = Vec3::Zero();
  std::vector<Posed> meshes_;  // by mesh ID
};

}  // namespace echopath
