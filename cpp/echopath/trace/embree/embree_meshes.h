#pragma once
// Holds what Embree reads: the vertices of all meshes at one time, relative to an origin. An update to another time computes
// only those anew that differ.
#include <functional>
#include <memory>
#include <vector>

#include "echopath/base/memory/lazy.h"
#include "echopath/posed/posed_scene.h"

namespace echopath {

// Says which surfaces a query looks at, as a mask of bits. Sheets (Material::layers) let waves pass, so that most queries
// go through them.
enum class Sees : uint32_t { kOpaque = 0x7FFFFFFFu, kSheets = 0x80000000u, kAll = 0xFFFFFFFFu };

class EmbreeMeshes {
 public:
  // Returns the origin (m, world) for meshes within a bounding box (m, world).
  using OriginRule = std::function<Vec3(const Box& box)>;
  // Returns the IDs of the meshes that differ from those of the last call, ascending: all meshes where the origin or the
  // number of meshes has changed, none where nothing moves. Raises invalid_argument naming the mesh that is out of the range
  // of coordinates (base/range_of_coordinates.h) about the origin; after that it may only be destroyed.
  std::vector<uint32_t> update(const Scene& scene, const PosedScene& pose, const OriginRule& origin);

  const Vec3& origin() const { return origin_; }  // m, world
  uint32_t size() const { return static_cast<uint32_t>(meshes_.size()); }
  const Mesh& mesh(uint32_t mesh_id) const { return *meshes_[mesh_id].source.mesh; }
  const std::vector<Triangle>& triangles(uint32_t mesh_id) const { return mesh(mesh_id).triangles(); }
  const std::vector<Vec3>& vertices(uint32_t mesh_id) const { return meshes_[mesh_id].vertices; }  // m
  // Returns the unit normals of the vertices; they are empty where the mesh is not smooth.
  const std::vector<Vec3>& normals(uint32_t mesh_id) const { return meshes_[mesh_id].normals; }
  bool is_moving(uint32_t mesh_id) const { return meshes_[mesh_id].source.is_moving; }  // Scene::is_moving
  // Returns the linear part of the pose where the mesh is rigid, else null.
  const Mat3* rigid_pose(uint32_t mesh_id) const;
  bool is_sheet(uint32_t mesh_id) const { return meshes_[mesh_id].source.is_sheet; }
  // Returns the bit of a mesh: that of sheets, or else the same for all below one child of the scene's root, and one of 31.
  uint32_t mask_of(uint32_t mesh_id) const {
    if (is_sheet(mesh_id)) return static_cast<uint32_t>(Sees::kSheets);
    return uint32_t{1} << (static_cast<unsigned>(meshes_[mesh_id].source.object) % 31u);
  }
  Box box(uint32_t mesh_id) const;  // m
  // Returns the width in m that `measure` gives for the mesh, or gave since its vertices were last computed.
  double width(uint32_t mesh_id, const std::function<double()>& measure) const {
    return meshes_[mesh_id].width->get(measure);
  }
  const Box& world_box(uint32_t mesh_id) const { return world_boxes_[mesh_id]; }

  struct Extent {
    Box box;                          // m, of all meshes
    double largest_coordinate = 0.0;  // m, of all vertices by magnitude
    double mean_cover = 0.0;          // mean number of boxes of meshes in which a point of the box of all lies
    bool is_anything_moving = false;
  };
  Extent extent() const;

 private:
  // Names all that the vertices follow from: equal sources have equal vertices.
  struct Source {
    MeshPtr mesh;
    std::shared_ptr<const Deformation> deformation;
    double time = 0.0;                // s, where it deforms
    Mat3 linear = Mat3::Identity();   // of the pose
    Vec3 translation = Vec3::Zero();  // m, world
    bool smooth = false, is_moving = false, is_sheet = false;
    int object = -1;  // SceneMesh::object
    bool is_of(const Scene& scene, const PosedScene& pose, uint32_t mesh_id) const;
  };
  struct Posed {
    Source source;
    std::vector<Vec3> vertices, normals;
    std::unique_ptr<Lazy<double>> width;  // m
  };
  static Source source_of(const Scene& scene, const PosedScene& pose, uint32_t mesh_id);
  std::vector<uint32_t> take_sources(const Scene& scene, const PosedScene& pose);
  void place_in_world(const PosedScene& pose, uint32_t mesh_id);
  void count_from_origin(const Scene& scene, uint32_t mesh_id);

  Vec3 origin_ = Vec3::Zero();
  std::vector<Posed> meshes_;     // by mesh ID, as the next one
  std::vector<Box> world_boxes_;  // m
};

}  // namespace echopath
